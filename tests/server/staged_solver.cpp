#include "tests/server/staged_solver.h"

namespace alvor {

Solver StagedSolver::solver() {
  return [this](const BaseMesh&, const Plan&, const SolveOptions&, SolutionLog& log, const SolveControl& control) {
    return run(log, control.stop);
  };
}

SolveOutcome StagedSolver::run(SolutionLog& log, std::stop_token stop) {
  std::unique_lock hold(lock_);
  log_ = &log;
  changed_.notify_all();
  const bool told = changed_.wait(hold, stop, [this] { return finished_; });
  log_ = nullptr;
  if (told && !failure_.empty()) throw std::runtime_error(failure_);
  return {.reason = told ? StopReason::tolerance : StopReason::cancelled};
}

SolutionLog& StagedSolver::log() {
  std::unique_lock hold(lock_);
  changed_.wait(hold, [this] { return log_ != nullptr; });
  return *log_;
}

void StagedSolver::finish() {
  std::scoped_lock hold(lock_);
  finished_ = true;
  changed_.notify_all();
}

void StagedSolver::fail(const std::string& reason) {
  std::scoped_lock hold(lock_);
  failure_ = reason;
  finished_ = true;
  changed_.notify_all();
}

}  // namespace alvor
