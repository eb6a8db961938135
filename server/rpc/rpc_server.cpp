#include "server/rpc/rpc_server.h"

#include <grpcpp/grpcpp.h>

#include <stdexcept>

namespace alvor {

namespace {

constexpr int handshake_ms = 10'000;  // time for a connection's TLS handshake and HTTP/2 preface
constexpr int idle_ms = 5 * 60'000;   // without a call; clients reconnect when they need to
constexpr int most_streams = 256;     // on one connection at a time
constexpr int metadata_bytes = 16'384;

/// Sets limits and keepalive, so that a peer that vanished does not keep its watches for ever. A break of 5 s is survived: TCP
/// resends until 6.3 s after the break began.
void bound(grpc::ServerBuilder& builder) {
  builder.AddChannelArgument(GRPC_ARG_SERVER_HANDSHAKE_TIMEOUT_MS, handshake_ms);
  builder.AddChannelArgument(GRPC_ARG_MAX_CONNECTION_IDLE_MS, idle_ms);
  builder.AddChannelArgument(GRPC_ARG_MAX_CONCURRENT_STREAMS, most_streams);
  builder.AddChannelArgument(GRPC_ARG_MAX_METADATA_SIZE, metadata_bytes);
  builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_TIME_MS, 10'000);
  builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_TIMEOUT_MS, 10'000);
  builder.AddChannelArgument(GRPC_ARG_HTTP2_MIN_RECV_PING_INTERVAL_WITHOUT_DATA_MS, 5'000);  // clients may ping as often
}

}  // namespace

RpcServer::RpcServer(std::shared_ptr<FrontDoor> door, std::shared_ptr<grpc::ServerCredentials> credentials,
                     const Configure& configure, std::function<void()> died)
    : door_(std::move(door)) {
  grpc::EnableDefaultHealthCheckService(true);
  grpc::ServerBuilder builder;
  bound(builder);
  acceptor_ = builder.experimental().AddExternalConnectionAcceptor(
      grpc::ServerBuilder::experimental_type::ExternalConnectionType::FROM_FD, std::move(credentials));
  configure(builder);
  server_ = builder.BuildAndStart();
  if (!server_) throw std::runtime_error("gRPC cannot serve on " + door_->address());
  const auto take = [this](int connection) {
    grpc::experimental::ExternalConnectionAcceptor::NewConnectionParameters accepted;
    accepted.fd = connection;
    acceptor_->HandleNewConnection(&accepted);
  };
  door_->open(take, std::move(died));
}

RpcServer::~RpcServer() { shut_down(std::chrono::milliseconds(0)); }

void RpcServer::shut_down(std::chrono::milliseconds grace) {
  door_->close();
  server_->Shutdown(std::chrono::system_clock::now() + grace);
}

}  // namespace alvor
