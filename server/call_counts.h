#pragma once
// How many calls ended how.

#include <grpcpp/support/server_interceptor.h>

#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

namespace alvor {

/// By method and status code. Thread-safe.
class CallCounts {
 public:
  using Counts = std::map<std::pair<std::string, grpc::StatusCode>, std::uint64_t>;
  void note(const std::string& method, grpc::StatusCode code);
  Counts counts() const;

 private:
  mutable std::mutex lock_;
  Counts counts_;
};

/// Notes each call of a server when its status is sent; one that its client breaks off before that is not noted. `counts` must
/// outlive the server.
std::unique_ptr<grpc::experimental::ServerInterceptorFactoryInterface> counting_calls(CallCounts& counts);

}  // namespace alvor
