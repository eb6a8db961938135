#pragma once

#include "server/solves/stored_solve.h"

#include <condition_variable>
#include <mutex>
#include <string>

namespace alvor {

/// A solver that the test controls step by step. One solve at a time.
class StagedSolver {
 public:
  Solver solver();
  /// Returns the log of the running solve, to which the test publishes; waits for the solve to start.
  SolutionLog& log();
  /// Returns the size of the checkpoint from which the running solve continues; waits for the solve to start.
  std::size_t resumed_from();
  /// Ends the running solve, and those that begin later.
  void finish();
  /// Makes solves that begin later wait for finish() again. Requires: none runs.
  void begin_again();
  void fail(const std::string& reason);

 private:
  SolveOutcome run(SolutionLog& log, const SolveControl& control);

  std::mutex lock_;
  std::condition_variable_any changed_;
  SolutionLog* log_ = nullptr;
  std::size_t resumed_from_ = 0;
  bool finished_ = false;
  std::string failure_;
};

}  // namespace alvor
