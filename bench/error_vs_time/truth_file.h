#pragma once
// Truths are kept from one run to the next.

#include "bench/error_vs_time/truth.h"

#include <filesystem>
#include <optional>
#include <string>

namespace alvor::bench {

/// What a truth is the answer to, as one line: the scene's numbers mixed to one, points, paths, seed.
std::string truth_question(const Scene& scene, const SceneSettings& settings, std::uint64_t seed);

/// Nothing if there is no such file, or it answers another question, or is broken.
std::optional<Truth> read_truth(const std::filesystem::path& path, const std::string& question);

/// Makes the folder too. Throws FileError.
void write_truth(const std::filesystem::path& path, const std::string& question, const Truth& truth);

}  // namespace alvor::bench
