#pragma once
// Moments of a growing solution, kept to be drawn later.

#include "solution/solution_mirror.h"

#include <cstddef>
#include <vector>

namespace alvor {

struct Snapshot {
  std::uint64_t revision = 0;
  RgbF ambient_irradiance;  ///< display only, W/m2
  std::vector<LeafValue> leaves;
};

/// Requires: !mirror.steps().empty().
Snapshot snapshot_of(const SolutionMirror& mirror);

/// Keeps at most `most` of the moments offered, evenly spread over them: when full, every other one goes and only every other one
/// of those to come is taken. So no fewer than most / 2 are kept of `most` or more.
class Snapshots {
 public:
  static constexpr std::size_t most = 60;

  /// Mirrors that are not whole equal no state of the solve and are passed over, as are revisions already seen.
  void offer(const SolutionMirror& mirror);
  /// What was kept, oldest first, ending with the state of `last`. Leaves nothing behind.
  std::vector<Snapshot> take(const SolutionMirror& last);

 private:
  void thin_out();

  std::vector<Snapshot> kept_;
  std::uint64_t newest_ = 0;  ///< revision last offered
  std::size_t offered_ = 0;
  std::size_t stride_ = 1;
};

}  // namespace alvor
