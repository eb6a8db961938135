#include "tests/server/staged_solver.h"

namespace alvor {

Solver StagedSolver::solver() {
  return [this](const SceneContent&, const Plan&, const SolveOptions&, SolutionLog& log, const SolveControl& control) {
    return run(log, control);
  };
}

SolveOutcome StagedSolver::run(SolutionLog& log, const SolveControl& control) {
  const std::stop_callback wake(control.park, [this] {
    std::scoped_lock hold(lock_);
    changed_.notify_all();
  });
  std::unique_lock hold(lock_);
  log_ = &log;
  resumed_from_ = control.checkpoint.size();
  changed_.notify_all();
  const bool told = changed_.wait(hold, control.stop, [&] { return finished_ || control.park.stop_requested(); });
  log_ = nullptr;
  if (told && !failure_.empty()) throw std::runtime_error(failure_);
  if (told && control.park.stop_requested()) {
    hold.unlock();
    control.save([](PlainWriter& out) { out.put(std::uint32_t{7}); });
    return {.reason = StopReason::parked};
  }
  return {.reason = told ? StopReason::tolerance : StopReason::cancelled};
}

SolutionLog& StagedSolver::log() {
  std::unique_lock hold(lock_);
  changed_.wait(hold, [this] { return log_ != nullptr; });
  return *log_;
}

std::size_t StagedSolver::resumed_from() {
  log();
  std::scoped_lock hold(lock_);
  return resumed_from_;
}

void StagedSolver::finish() {
  std::scoped_lock hold(lock_);
  finished_ = true;
  changed_.notify_all();
}

void StagedSolver::begin_again() {
  std::scoped_lock hold(lock_);
  finished_ = false;
}

void StagedSolver::fail(const std::string& reason) {
  std::scoped_lock hold(lock_);
  failure_ = reason;
  finished_ = true;
  changed_.notify_all();
}

}  // namespace alvor
