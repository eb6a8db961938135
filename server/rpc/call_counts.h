#pragma once
// Counts calls by method and status code.

#include "server/base/mutex.h"

#include <grpcpp/support/server_interceptor.h>

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <unordered_map>
#include <utility>

namespace alvor {

/// Counts ended calls by method and status code, and open calls by connection. Thread-safe.
class CallCounts {
 public:
  /// Open calls of one connection beyond which it is reported as flooding. gRPC allows 256 streams at a time but does not count
  /// streams that were reset and not yet cleaned up.
  static constexpr int most_of_connection = 1000;

  /// `flooding` is called with the peer of each connection that exceeds most_of_connection, as gRPC writes it:
  /// "ipv4:127.0.0.1:50051".
  explicit CallCounts(std::function<void(const std::string&)> flooding) : flooding_(std::move(flooding)) {}
  using Counts = std::map<std::pair<std::string, grpc::StatusCode>, std::uint64_t>;
  void note(const std::string& method, grpc::StatusCode code);
  void begin(const std::string& peer);
  void end(const std::string& peer);
  Counts counts() const;

 private:
  const std::function<void(const std::string&)> flooding_;
  mutable Mutex lock_;
  Counts counts_ ALVOR_GUARDED_BY(lock_);
  std::unordered_map<std::string, int> under_way_ ALVOR_GUARDED_BY(lock_);  ///< open calls by peer
};

/// Returns an interceptor that counts each call when its status is sent. A call that its client cancels before that is not
/// counted by status. `counts` must outlive the server.
std::unique_ptr<grpc::experimental::ServerInterceptorFactoryInterface> counting_calls(CallCounts& counts);

}  // namespace alvor
