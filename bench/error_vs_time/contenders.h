#pragma once
// Each runs once, its time is taken, and its error found afterwards.

#include "bench/error_vs_time/measured_run.h"
#include "bench/error_vs_time/truth.h"
#include "meshing/base_mesh.h"

namespace alvor::bench {

/// What all runs on one scene share. Borrows it.
struct Arena {
  const SceneSettings& settings;
  const Scene& scene;
  const BaseMesh& mesh;
  const Truth& truth;
  double time_limit_s, fixed_mesh_limit_s;
};

/// Requires: contender is auto or a strategy.
MeasuredRun solve_with(const Arena& arena, Contender contender, double tolerance, int threads, std::uint64_t seed);

MeasuredRun shoot_with(const Arena& arena, int cells);

/// At all points of the truth, by other paths.
MeasuredRun trace_with(const Arena& arena, std::uint64_t paths);

}  // namespace alvor::bench
