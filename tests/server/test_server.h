#pragma once

#include "server/rpc/service.h"

#include <grpcpp/grpcpp.h>

#include <memory>

namespace alvor {

/// A service with options, reached through an in-process channel.
class TestServer {
 public:
  explicit TestServer(ServiceOptions options = {});
  ~TestServer();
  std::shared_ptr<grpc::Channel> channel() { return server_->InProcessChannel({}); }
  void stop_service() { service_.shut_down(); }
  std::shared_ptr<prometheus::Collectable> metrics() const { return service_.metrics(); }

 private:
  Service service_;
  std::unique_ptr<grpc::Server> server_;
};

}  // namespace alvor
