#pragma once
// Judges solves that a limit of time, depth or leaves ends: whether the limit is kept, and whether the solve is cheaper for it.

#include "bench/error_vs_time/page/page.h"
#include "bench/error_vs_time/page/targets.h"

#include <span>
#include <string>

namespace alvor::bench {

/// Judges by how much the solves that were stopped took longer than their time limits.
Judgement judge_overtime(std::span<const SceneContest> contests);
/// Judges whether each scene's error falls, or stays within noise, from each time limit to the next.
Judgement judge_more_time(std::span<const SceneContest> contests);
/// Judges whether solves with a limit to their mesh cast at most the rays of those without.
Judgement judge_mesh_limits(std::span<const SceneContest> contests);

/// The section about limits; empty if no solve had any.
std::string limits_section(const Measurements& measured);

}  // namespace alvor::bench
