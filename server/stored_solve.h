#pragma once
// One solve: what was asked, the log it fills, and how it ended.

#include "alvor/v1/solve_service.pb.h"
#include "radiosity/solver.h"
#include "server/scene_store.h"

#include <functional>
#include <memory>
#include <mutex>
#include <stop_token>
#include <string>

namespace alvor {

/// solve_as_planned, or what stands in for it.
using Solver = std::function<SolveOutcome(const BaseMesh&, const Plan&, const SolveOptions&, SolutionLog&, const SolveControl&)>;

/// Thread-safe.
class StoredSolve {
 public:
  StoredSolve(std::uint64_t solve_number, std::shared_ptr<const StoredScene> scene, const v1::SolveSpec& spec,
              const SolveOptions& options);

  const std::uint64_t number;
  const std::string name;
  SolutionLog log;

  /// Solves on the calling thread; an exception of the solver makes the solve FAILED. To be called once. When it returns, ended()
  /// holds and the log is closed.
  void run(const Solver& solver, std::stop_token stop);
  /// The state will not change and the log will not grow. Listeners of the log are woken after this became true.
  bool ended() const;
  /// As the API tells it.
  v1::Solve describe() const;

 private:
  void show(const Plan& plan);
  void end(v1::Solve::State state, const std::string& reason, const SolveOutcome& outcome);

  const std::shared_ptr<const StoredScene> scene_;
  const SolveOptions options_;
  mutable std::mutex lock_;
  v1::Solve facts_;  ///< all but the last step
};

}  // namespace alvor
