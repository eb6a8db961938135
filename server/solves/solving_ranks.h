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
  /// Of the first rank: lets the others end. No solve may run.
  ~SolvingRanks();
  SolvingRanks(const SolvingRanks&) = delete;

  std::size_t size() const { return ranks().size(); }
  bool is_first() const { return ranks().is_first(); }
  /// Returns the most threads that a solve may use on each rank.
  int threads() const;
  /// Of the others: takes part in solves until the first rank ends.
  void follow();
  /// Of the first: returns what solves on all ranks, one solve at a time, or in this process alone if the options ask for what
  /// only one rank can do. This must outlive it.
  Solver solver();

 private:
  Ranks& ranks() const { return several_ ? *several_ : Ranks::alone(); }
  const std::unique_ptr<Ranks> several_;  ///< null: there is one
};

}  // namespace alvor
