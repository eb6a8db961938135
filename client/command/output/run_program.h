#pragma once
// Runs another program.

#include <filesystem>
#include <string>
#include <vector>

namespace alvor {

/// Runs a program in `folder`, found as a shell finds it, with these arguments and without output, and waits for its end. Returns
/// whether it could be run and ended with status 0.
bool run_program(const std::filesystem::path& folder, const std::string& program, std::vector<std::string> arguments);

}  // namespace alvor
