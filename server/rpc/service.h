#pragma once
// The whole Alvor service, for any gRPC server: alvord's or one in another process.

#include "server/access/tenants.h"
#include "server/scenes/scene_upload.h"
#include "server/solves/solve_store.h"

#include <grpcpp/server_builder.h>
#include <prometheus/collectable.h>

#include <functional>
#include <memory>

namespace alvor {

struct ServiceOptions {
  UploadLimits upload;
  Archive* archive = nullptr;  ///< must outlive the service; null: everything is only in memory
  Quota quota;                 ///< for each tenant
  /// The callers' tokens; null: all callers are one tenant.
  std::shared_ptr<const BearerTokens> tokens;
  std::string identity_header;  ///< see ListenOptions
  MemoryGuard memory;
  /// Called with the peer of a connection that has too many calls under way, see CallCounts. From any thread.
  std::function<void(const std::string& peer)> flooding = [](const std::string&) {};
  SolveStoreOptions solves;  ///< its logger is used by the whole service
};

/// All services and stores of a server. Call in this order: register_with, start the server, shut_down, shut the server down,
/// destroy. A server that uses the service must be shut down before the service is destroyed.
class Service {
 public:
  Service();
  explicit Service(ServiceOptions options);
  ~Service();
  void register_with(grpc::ServerBuilder& builder);
  /// Ends all watches, parks or cancels all solves (SolveStore::shut_down) and waits for them. Later CreateSolve and WatchSolve
  /// calls are UNAVAILABLE.
  void shut_down();
  /// Returns the metrics, which may be collected as long as the service exists.
  std::shared_ptr<prometheus::Collectable> metrics() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace alvor
