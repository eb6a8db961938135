#include "server/rpc/health.h"

#include "grpc/health/v1/health.grpc.pb.h"

#include <grpcpp/grpcpp.h>
#include <grpcpp/health_check_service_interface.h>

#include <algorithm>
#include <chrono>
#include <stdexcept>

namespace alvor {

namespace health = grpc::health::v1;

HealthPort::HealthPort(const std::string& address, std::size_t most_connections) {
  const ConnectionLimits limits{most_connections, std::max<std::size_t>(most_connections / 2, 1)};
  try {
    rpc_ = std::make_unique<RpcServer>(
        std::make_shared<FrontDoor>(address, limits), grpc::InsecureServerCredentials(),
        [this](grpc::ServerBuilder& builder) { unused_ = builder.AddCompletionQueue(); }, [] {});
  } catch (const std::exception& fault) {
    throw std::invalid_argument(std::string("--health: ") + fault.what());
  }
  set_serving(rpc_->server(), false);
}

HealthPort::~HealthPort() {
  rpc_->shut_down({});
  drain();
}

void HealthPort::drain() {
  unused_->Shutdown();
  void* tag = nullptr;
  for (bool ok = false; unused_->Next(&tag, &ok);) {}
}

void set_serving(grpc::Server& server, bool is_serving) {
  grpc::HealthCheckServiceInterface& service = *server.GetHealthCheckService();
  service.SetServingStatus(is_serving);
  for (const char* name : {"alvor.v1.SceneService", "alvor.v1.SolveService"}) service.SetServingStatus(name, is_serving);
}

std::string probe_health(const std::string& address) {
  const auto channel = grpc::CreateChannel(address, grpc::InsecureChannelCredentials());
  grpc::ClientContext context;
  context.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(3));
  health::HealthCheckResponse response;
  const grpc::Status status = health::Health::NewStub(channel)->Check(&context, health::HealthCheckRequest(), &response);
  if (!status.ok()) return status.error_message();
  if (response.status() == health::HealthCheckResponse::SERVING) return "";
  return health::HealthCheckResponse::ServingStatus_Name(response.status());
}

}  // namespace alvor
