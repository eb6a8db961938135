#pragma once
// Solves together with the other ranks that a launcher started.

#include "radiosity/ranks/ranks.h"
#include "server/solves/stored_solve.h"

#include <memory>

namespace alvor {

/// The ranks of this program. The first one reads, writes and speaks; the others only take part in its solves. Made once, on the
/// main thread, and destroyed by it last.
class SolvingRanks {
 public:
  /// As launched_ranks() finds them: a single one if the program was started alone.
  SolvingRanks();
  explicit SolvingRanks(std::unique_ptr<Ranks> ranks);
  /// Lets follow() return on the other ranks, if this is the first one. No solve may run.
  ~SolvingRanks();
  SolvingRanks(const SolvingRanks&) = delete;

  std::size_t size() const { return ranks().size(); }
  bool is_first() const { return ranks().is_first(); }
  /// Returns the most threads that a solve may use on each rank.
  int threads() const;
  /// Takes part in the solves of the first rank until that one ends. Requires: !is_first().
  void follow();
  /// Returns a solver for the first rank. It solves on all ranks, one solve at a time, or in this process alone if the options
  /// ask for what only one rank can do. Must not be called after this was destroyed.
  Solver solver();

 private:
  Ranks& ranks() const { return several_ ? *several_ : Ranks::alone(); }
  const std::unique_ptr<Ranks> several_;  ///< null: there is one
};

}  // namespace alvor
