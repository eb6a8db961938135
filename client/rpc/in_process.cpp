#include "client/rpc/in_process.h"

#include "server/rpc/service.h"

#include <chrono>

namespace alvor {

struct InProcessServer::Parts {
  Service service;
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
