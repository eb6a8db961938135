#pragma once
// Stores truths in files from one run to the next.

#include "bench/error_vs_time/contest/truth.h"

#include <filesystem>
#include <optional>
#include <string>

namespace alvor::bench {

/// Returns one line that identifies a truth: a hash of the scene, and points, paths and seed.
std::string truth_question(const Scene& scene, const SceneSettings& settings, std::uint64_t seed);

/// Reads a truth. Returns nothing if there is no such file, it has another `question`, or it is malformed.
std::optional<Truth> read_truth(const std::filesystem::path& path, const std::string& question);

/// Writes a truth; makes the folder if needed. Throws FileError.
void write_truth(const std::filesystem::path& path, const std::string& question, const Truth& truth);

}  // namespace alvor::bench
