#pragma once

#include "server/solves/stored_solve.h"

#include <condition_variable>
#include <mutex>
#include <string>

namespace alvor {

/// A solver that does what the test tells it, step by step. One solve at a time.
class StagedSolver {
 public:
  Solver solver();
  /// Of the running solve; waits for it to start. The test publishes to it.
  SolutionLog& log();
  /// Bytes of the checkpoint that the running solve goes on from; waits for it to start.
  std::size_t resumed_from();
  void finish();
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
