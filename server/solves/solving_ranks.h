#pragma once
// Solves together with the other ranks that a launcher started.

#include "radiosity/ranks/ranks.h"
#include "server/base/memory_guard.h"
#include "server/base/mutex.h"
#include "server/solves/stored_solve.h"

#include <atomic>
#include <memory>
#include <vector>

namespace alvor {

struct SolveStoreOptions;

/// The process of one rank: its memory, its processor time, and whether it is at work.
struct RankStatus {
  std::uint64_t resident_bytes = 0;  ///< memory, as resident_bytes() counts it
  std::uint64_t memory_limit = 0;
  double cpu_s = 0;         ///< processor time of the process so far
  bool is_solving = false;  ///< whether it shares in the work of a solve
};

/// The ranks of this program. The first one reads, writes and speaks; the others only take part in its solves. Each solve has a
/// gang of ranks; the first rank is in every gang, but shares in the work of one of them only. Made once, on the main thread, and
/// destroyed by it last. Thread-safe for the rest.
class SolvingRanks {
 public:
  struct Options {
    /// Ranks that share in the work of each solve; more than there are is all of them. 0: one for every 5 000 faces of its scene,
    /// of those that are free.
    std::size_t gang = 0;
    /// Guard of the memory of this process. If it is short on a rank other than the first, the solve in which that rank takes
    /// part ends. On the first rank the SolveStore, which has a guard of its own, sees to that.
    MemoryGuard memory = {};
  };
  /// As launched_ranks() finds them: a single one if the program was started alone.
  explicit SolvingRanks(Options options);
  SolvingRanks(std::unique_ptr<Ranks> ranks, Options options);
  /// Lets follow() return on the other ranks, if this is the first one. No solve may run.
  ~SolvingRanks();
  SolvingRanks(const SolvingRanks&) = delete;

  std::size_t size() const { return ranks().size(); }
  bool is_first() const { return ranks().is_first(); }
  /// Returns the most threads that a solve may use on each rank.
  int threads() const;
  /// Returns how many solves can have a gang at a time.
  std::size_t most_gangs() const;

  /// Takes part in the solves of the first rank until that one ends. Requires: !is_first().
  void follow();
  /// Returns a solver for one solve on the first rank, which holds a gang until it is destroyed; or an empty one while no rank is
  /// free. It solves in this process alone if the options ask for what only one rank can do.
  Solver solver_for(std::uint64_t faces, const SolveOptions& options);
  /// Lets a store on the first rank solve by solver_for(), as many solves at a time as can have a gang and no more than it would
  /// otherwise. Must outlive the store.
  void solve_for(SolveStoreOptions& options);
  /// Asks all ranks. Requires: is_first().
  std::vector<RankStatus> statuses();

 private:
  class Gang;
  Ranks& ranks() const { return several_ ? *several_ : Ranks::alone(); }
  std::vector<std::size_t> take_free(std::uint64_t faces);
  void give_back(const std::vector<std::size_t>& workers);
  std::unique_ptr<Ranks> call_together(const std::vector<std::size_t>& workers);
  void take_part(Ranks& gang);
  void answer_questions();
  std::vector<RankStatus> tell_statuses();

  const Options options_;
  const std::unique_ptr<Ranks> several_;  ///< null: there is one
  /// Pairs of the first rank and another one, by which the first rank calls the other into gangs. On the first rank: the pair
  /// with rank r + 1 at place r. On any other rank: its own pair alone.
  std::vector<std::unique_ptr<Ranks>> lines_;
  std::unique_ptr<Ranks> asking_;         ///< all ranks, for statuses(); null: there is one
  std::atomic<bool> is_solving_ = false;  ///< whether this rank, which is not the first, takes part in a solve
  Mutex calling_, asking_lock_;           ///< one gang is called together, one status asked for, at a time
  Mutex lock_;
  std::vector<bool> is_free_ ALVOR_GUARDED_BY(lock_);  ///< by rank
};

}  // namespace alvor
