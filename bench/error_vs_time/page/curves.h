#pragma once
// Writes the data that gnuplot draws.

#include "bench/error_vs_time/contest/contest.h"

#include <filesystem>

namespace alvor::bench {

/// Writes SCENE.dat for each scene, with one block for each contender in the order of the enumeration, and estimates.dat with one
/// block for each scene. Throws FileError.
void write_curves(const std::filesystem::path& folder, std::span<const SceneContest> contests);

}  // namespace alvor::bench
