#pragma once
// Tells whether the server takes calls (grpc.health.v1), for supervisors and load balancers.

#include "server/rpc/rpc_server.h"

#include <grpcpp/completion_queue.h>

#include <memory>
#include <string>

namespace alvor {

/// A server on an address of its own that answers only health checks, without TLS and tokens, which most probes lack. Starts as
/// NOT_SERVING.
class HealthPort {
 public:
  /// Listens on `address` and holds at most `most_connections` at a time. Throws std::invalid_argument if it cannot listen there.
  explicit HealthPort(const std::string& address, std::size_t most_connections = 50);
  ~HealthPort();
  HealthPort(const HealthPort&) = delete;
  HealthPort& operator=(const HealthPort&) = delete;

  grpc::Server& server() { return rpc_->server(); }
  const std::string& address() const { return rpc_->address(); }

 private:
  void drain();

  std::unique_ptr<grpc::ServerCompletionQueue> unused_;  ///< gRPC requires one, as we register no service
  std::unique_ptr<RpcServer> rpc_;
};

/// Sets the health of the server as a whole and of each of its services.
void set_serving(grpc::Server& server, bool is_serving);

/// Returns "" if the HealthPort at `address` says SERVING, else the reason why not.
std::string probe_health(const std::string& address);

}  // namespace alvor
