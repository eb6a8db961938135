#pragma once
// How much memory a solve takes at most.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace alvor::bench {

/// Runs a program with the arguments, without its output, and returns the most memory, in bytes, that it, a process it waited
/// for, or a program that this process ran before held at once (maximum resident set size). Memory that this process holds at
/// that time counts too, if it is more. Throws std::runtime_error if the program cannot be run or does not end with 0.
std::uint64_t peak_memory_of(const std::filesystem::path& program, const std::vector<std::string>& arguments);

}  // namespace alvor::bench
