#pragma once
// Keeps moments of a growing solution, to be drawn later.

#include "solution/solution_mirror.h"

#include <cstddef>
#include <vector>

namespace alvor {

struct Snapshot {
  std::uint64_t revision = 0;
  RgbF ambient_irradiance;  ///< display only, W/m2
  std::vector<LeafValue> leaves;
};

/// Returns the mirror's state. Requires: !mirror.steps().empty().
Snapshot snapshot_of(const SolutionMirror& mirror);

/// Keeps at most `most` of the moments offered, evenly spread over them. When full, it drops every other moment and from then on
/// takes only every other one of those that it would have taken. So at least most / 2 are kept when `most` or more were offered.
class Snapshots {
 public:
  static constexpr std::size_t most = 60;

  /// Offers the mirror's state. Ignored if the mirror is not whole, as it then equals no state of the solve, or if its revision
  /// was offered before.
  void offer(const SolutionMirror& mirror);
  /// Returns the kept moments, oldest first, ending with the state of `last`, and forgets them.
  std::vector<Snapshot> take(const SolutionMirror& last);

 private:
  void thin_out();

  std::vector<Snapshot> kept_;
  std::uint64_t newest_ = 0;  ///< revision last offered
  std::size_t offered_ = 0;
  std::size_t stride_ = 1;
};

}  // namespace alvor
