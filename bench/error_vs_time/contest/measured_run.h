#pragma once
// One run of one program on one scene, and groups of runs that differ only in their seed.

#include "bench/error_vs_time/contest/statistics.h"
#include "client/verify/error_statistics.h"

#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace alvor::bench {

/// Alvor by its own choice, or by another strategy; textbook shooting; path tracing; Alvor with some MethodParts left out; and
/// Alvor with a limit that ends it before its tolerance.
enum class Contender {
  alvor,
  gather,
  shoot,
  sorted,
  overshoot,
  fixed_mesh,
  path_tracing,
  no_part,
  exact_shadows_alone,
  guided_rays_alone,
  slabs_alone,
  unseen_places_alone,
  no_exact_shadows,
  no_guided_rays,
  no_slabs,
  no_unseen_places,
  until_time,
  to_depth,
  sorted_to_depth,
  to_leaves
};
inline constexpr Contender strategies[]{Contender::gather, Contender::shoot, Contender::sorted, Contender::overshoot};
inline constexpr Contender with_parts_left_out[]{Contender::no_part,
                                                 Contender::exact_shadows_alone,
                                                 Contender::guided_rays_alone,
                                                 Contender::slabs_alone,
                                                 Contender::unseen_places_alone,
                                                 Contender::no_exact_shadows,
                                                 Contender::no_guided_rays,
                                                 Contender::no_slabs,
                                                 Contender::no_unseen_places};

/// Limits of the mesh. MeasuredRun::setting is the limit: levels below the roots, or leaves.
inline constexpr Contender with_mesh_limits[]{Contender::to_depth, Contender::sorted_to_depth, Contender::to_leaves};

std::string_view text(Contender contender);
/// Returns whether it is one of with_parts_left_out.
bool lacks_parts(Contender contender);

struct MeasuredRun {
  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

  std::string scene;
  Contender contender = Contender::alvor;
  double setting = 0;  ///< tolerance, or the limit; fixed mesh: cells on the longest side; path tracing: paths per point
  int threads = 1;
  std::uint64_t seed = 1;
  double cpu_s = 0, wall_s = 0;
  std::uint64_t rays = 0, leaves = 0;  ///< 0 if not counted
  double estimated = unknown;          ///< nRMSE as estimated by the program itself
  Confidence nrmse;                    ///< against the truth
  double relative_rms = unknown;       ///< RMS over points of error / truth
  double within_two = unknown;         ///< share of the points whose error is within two of the told errors
  bool is_done = true;                 ///< false: a limit ended it, of time, depth or leaves
  static constexpr double far_above = 1.5;
  /// Published steps, and those whose estimate is more than far_above times that of the step before.
  std::uint64_t steps = 0, rises = 0;
};

/// Returns a CSV text with a header and a line for each run.
std::string runs_csv(std::span<const MeasuredRun> runs);

/// The runs of one contender, setting and number of threads.
struct RunGroup {
  Contender contender = Contender::alvor;
  double setting = 0;
  int threads = 1;
  std::vector<MeasuredRun> runs;  ///< not empty

  Spread cpu_s() const;
  Spread wall_s() const;
  Spread nrmse() const;
  Spread relative_rms() const;
  Spread estimated() const;
  Spread rays() const;
  Spread leaves() const;
  bool is_done() const;
};

/// Returns the runs in groups, in the order in which settings first appear.
std::vector<RunGroup> grouped(std::span<const MeasuredRun> runs);

/// Returns the groups of one contender and number of threads.
std::vector<RunGroup> of(std::span<const RunGroup> groups, Contender contender, int threads = 1);

/// Returns the medians of CPU time and error, one point per group.
std::vector<CurvePoint> error_by_cpu(std::span<const RunGroup> groups);
/// Returns the medians of CPU time and relative RMS error, one point per group.
std::vector<CurvePoint> relative_error_by_cpu(std::span<const RunGroup> groups);

}  // namespace alvor::bench
