#pragma once
// Runs the same service as alvord inside this process.

#include <grpcpp/grpcpp.h>

#include <memory>

namespace alvor {

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
