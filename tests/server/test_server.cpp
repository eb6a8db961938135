#include "tests/server/test_server.h"

#include <chrono>

namespace alvor {

TestServer::TestServer(ServiceOptions options) : service_(std::move(options)) {
  grpc::ServerBuilder builder;
  service_.register_with(builder);
  server_ = builder.BuildAndStart();
}

TestServer::~TestServer() {
  service_.shut_down();
  server_->Shutdown(std::chrono::system_clock::now() + std::chrono::seconds(5));
}

}  // namespace alvor
