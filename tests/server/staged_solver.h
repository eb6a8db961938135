#pragma once

#include "server/stored_solve.h"

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
  void finish();
  void fail(const std::string& reason);

 private:
  SolveOutcome run(SolutionLog& log, std::stop_token stop);

  std::mutex lock_;
  std::condition_variable_any changed_;
  SolutionLog* log_ = nullptr;
  bool finished_ = false;
  std::string failure_;
};

}  // namespace alvor
