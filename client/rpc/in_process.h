#pragma once
// Runs the same service as alvord inside this process.

#include <grpcpp/grpcpp.h>

#include <memory>
#include <stop_token>

namespace alvor {

class BaseMesh;
class SolutionLog;
struct Scene;
struct SolveOptions;
struct SolveOutcome;

/// The ranks of this program, if a launcher such as mpirun started several (server/solves/solving_ranks.h). The first rank's
/// InProcessServers, and solve_on_ranks(), solve on all of them. One of these, made first and destroyed last, on the main thread.
class ProgramRanks {
 public:
  ProgramRanks();
  ~ProgramRanks();
  ProgramRanks(const ProgramRanks&) = delete;
  /// Returns whether this is the first rank, or the only one.
  bool is_first() const;
  /// Takes part in the solves of the first rank until that one ends. Requires: !is_first().
  void follow();
};

/// Solves on all ranks of this program, by the strategy that its options ask for. `mesh` is that of the scene.
SolveOutcome solve_on_ranks(const Scene& scene, const BaseMesh& mesh, const SolveOptions& options, SolutionLog& log,
                            const std::stop_token& stop);

/// A server without a port. Stops its solves when destroyed; channels must not be used after that.
class InProcessServer {
 public:
  InProcessServer();
  ~InProcessServer();
  std::shared_ptr<grpc::Channel> channel();

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace alvor
