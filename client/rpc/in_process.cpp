#include "client/rpc/in_process.h"

#include "server/rpc/service.h"
#include "server/solves/solving_ranks.h"

#include <chrono>
#include <cstdint>

namespace alvor {

namespace {

std::unique_ptr<SolvingRanks> program_ranks;  // null without a ProgramRanks, as in tests

/// Files of the own disk may be larger than what a server takes from strangers.
ServiceOptions own_options() {
  ServiceOptions options;
  options.upload.bytes = std::uint64_t{16} << 30;
  if (program_ranks) program_ranks->solve_for(options.solves);
  return options;
}

}  // namespace

ProgramRanks::ProgramRanks() {
  constexpr std::size_t all = 65535;
  program_ranks = std::make_unique<SolvingRanks>(SolvingRanks::Options{.gang = all});
}
ProgramRanks::~ProgramRanks() { program_ranks.reset(); }
bool ProgramRanks::is_first() const { return program_ranks->is_first(); }
void ProgramRanks::follow() { program_ranks->follow(); }

SolveOutcome solve_on_ranks(const Scene& scene, const BaseMesh& mesh, const SolveOptions& options, SolutionLog& log,
                            const std::stop_token& stop) {
  if (!program_ranks || program_ranks->size() == 1) return solve(mesh, options, log, stop);
  const Solver solver = program_ranks->solver_for(mesh.roots().size(), options);
  SolveOptions how = options;
  if (how.threads == 0) how.threads = program_ranks->threads();
  return solver(SceneContent{scene, mesh}, Plan(mesh, how), how, log, {.stop = stop});
}

struct InProcessServer::Parts {
  Service service{own_options()};
  std::unique_ptr<grpc::Server> server;
};

InProcessServer::InProcessServer() : parts_(std::make_unique<Parts>()) {
  grpc::ServerBuilder builder;
  parts_->service.register_with(builder);
  parts_->server = builder.BuildAndStart();
}

InProcessServer::~InProcessServer() {
  parts_->service.shut_down();
  parts_->server->Shutdown(std::chrono::system_clock::now() + std::chrono::seconds(3));
}

std::shared_ptr<grpc::Channel> InProcessServer::channel() { return parts_->server->InProcessChannel({}); }

}  // namespace alvor
