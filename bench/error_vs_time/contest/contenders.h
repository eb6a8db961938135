#pragma once
// Runs each program once on a scene, measures its time, and finds its error afterwards.

#include "bench/error_vs_time/contest/measured_run.h"
#include "bench/error_vs_time/contest/truth.h"
#include "meshing/base_mesh.h"

namespace alvor::bench {

/// The inputs that all runs on one scene share. Borrows them.
struct Arena {
  const SceneSettings& settings;
  const Scene& scene;
  const BaseMesh& mesh;
  const Truth& truth;
  double time_limit_s, fixed_mesh_limit_s;
};

constexpr double tolerance_of_limited_meshes = 0.02;  ///< that solves by one of with_mesh_limits are asked for

/// Solves the scene with Alvor. `setting` is the tolerance, or the limit of a contender that has one. Requires: contender is none
/// of fixed_mesh and path_tracing.
MeasuredRun solve_with(const Arena& arena, Contender contender, double setting, int threads, std::uint64_t seed);

/// Solves the scene by textbook shooting, `cells` elements on the longest side.
MeasuredRun shoot_with(const Arena& arena, int cells);

/// Traces `paths` paths from each point of the truth, with other random numbers than the truth.
MeasuredRun trace_with(const Arena& arena, std::uint64_t paths);

}  // namespace alvor::bench
