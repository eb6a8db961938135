#pragma once
// A gRPC server whose connections come through a FrontDoor.

#include "server/access/front_door.h"

#include <grpcpp/server.h>
#include <grpcpp/server_builder.h>

#include <functional>
#include <memory>
#include <string>

namespace alvor {

/// Owns a gRPC server and its FrontDoor.
class RpcServer {
 public:
  using Configure = std::function<void(grpc::ServerBuilder&)>;

  /// Serves from now on. `configure` adds services and options to the builder. `died` is called, on another thread, when
  /// connections can no longer be accepted. Throws std::runtime_error if gRPC cannot start the server.
  RpcServer(std::shared_ptr<FrontDoor> door, std::shared_ptr<grpc::ServerCredentials> credentials, const Configure& configure,
            std::function<void()> died);
  /// Cancels the calls under way at once.
  ~RpcServer();
  RpcServer(const RpcServer&) = delete;
  RpcServer& operator=(const RpcServer&) = delete;

  /// Accepts no more connections; waits for the calls under way for at most `grace`.
  void shut_down(std::chrono::milliseconds grace);

  grpc::Server& server() { return *server_; }
  FrontDoor& door() { return *door_; }
  /// Returns the address with the port that the system assigned.
  const std::string& address() const { return door_->address(); }

 private:
  const std::shared_ptr<FrontDoor> door_;
  std::unique_ptr<grpc::experimental::ExternalConnectionAcceptor> acceptor_;
  std::unique_ptr<grpc::Server> server_;
};

}  // namespace alvor
