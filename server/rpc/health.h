#pragma once
// Whether the server takes calls (grpc.health.v1), for those who ask it in order to restart it or to send no more clients.

#include "server/rpc/rpc_server.h"

#include <grpcpp/completion_queue.h>

#include <memory>
#include <string>

namespace alvor {

/// Health and nothing else, on an address of its own: without TLS and tokens, which most probes do not have. NOT_SERVING at
/// first.
class HealthPort {
 public:
  /// Holds `most_connections` at a time. Throws std::invalid_argument if it cannot listen there.
  explicit HealthPort(const std::string& address, std::size_t most_connections = 50);
  ~HealthPort();
  HealthPort(const HealthPort&) = delete;
  HealthPort& operator=(const HealthPort&) = delete;

  grpc::Server& server() { return rpc_->server(); }
  const std::string& address() const { return rpc_->address(); }

 private:
  void drain();

  std::unique_ptr<grpc::ServerCompletionQueue> unused_;  ///< gRPC wants one where no service of ours does
  std::unique_ptr<RpcServer> rpc_;
};

/// Of the server as a whole and of each of its services.
void set_serving(grpc::Server& server, bool is_serving);

/// Empty if the HealthPort at `address` says SERVING, else why not.
std::string probe_health(const std::string& address);

}  // namespace alvor
