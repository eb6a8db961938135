#pragma once
// What gnuplot draws.

#include "bench/error_vs_time/contest.h"

#include <filesystem>

namespace alvor::bench {

/// SCENE.dat for each scene, with a block for each contender in the order of the enumeration, and estimates.dat with a block for
/// each scene. Throws FileError.
void write_curves(const std::filesystem::path& folder, std::span<const SceneContest> contests);

}  // namespace alvor::bench
