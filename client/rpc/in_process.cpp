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
  if (!program_ranks || program_ranks->size() == 1) return options;
  options.solves.solver = program_ranks->solver();
  options.solves.max_running = 1;
  options.solves.limits.threads = program_ranks->threads();
  return options;
}

}  // namespace

ProgramRanks::ProgramRanks() { program_ranks = std::make_unique<SolvingRanks>(); }
ProgramRanks::~ProgramRanks() { program_ranks.reset(); }
bool ProgramRanks::is_first() const { return program_ranks->is_first(); }
void ProgramRanks::follow() { program_ranks->follow(); }

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
