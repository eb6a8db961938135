#include "server/rpc/service.h"

#include "server/base/random_id.h"
#include "server/rpc/call_counts.h"
#include "server/rpc/metrics.h"
#include "server/rpc/scene_service.h"
#include "server/rpc/solve_service.h"

#include <spdlog/spdlog.h>

#include <algorithm>

namespace alvor {

namespace {

constexpr int largest_message = 64 << 20;
constexpr std::uint64_t least_importer_memory = 1 << 30;  ///< of address space; the libraries alone take a quarter of it

SolveStoreOptions solve_options(const ServiceOptions& service, const std::string& epoch) {
  SolveStoreOptions options = service.solves;
  options.keeping.archive = service.archive;
  options.keeping.epoch = epoch;
  options.keeping.memory = service.memory;
  options.quota = service.quota;
  options.memory = service.memory;
  return options;
}

UploadLimits upload_limits(const ServiceOptions& service) {
  UploadLimits limits = service.upload;
  limits.memory = service.memory;
  // Two importers at a time leave half of the memory to the server.
  if (service.memory.limit() > 0) limits.importer.memory_bytes = std::max(service.memory.limit() / 4, least_importer_memory);
  return limits;
}

}  // namespace

// The parts of the service, in the order of use: each may refer to those above it.
struct Service::Parts {
  explicit Parts(const ServiceOptions& options)
      : calls(options.flooding),
        watches(random_id('e'), options.quota.watchers),
        solve_store_options(solve_options(options, watches.epoch())),
        logger(solve_store_options.logger),
        scenes(options.archive, options.quota, options.memory),
        solves(solve_store_options, scenes),
        tenants(options.tokens, options.identity_header),
        scene_service(scenes, solves, tenants, upload_limits(options), pools, *logger),
        solve_service(scenes, solves, watches, tenants, pools, *logger),
        metrics(std::make_shared<Metrics>(scenes, solves, watches, calls, *solve_store_options.keeping.counts,
                                          solve_store_options.memory)) {}

  CallCounts calls;
  Watches watches;
  const SolveStoreOptions solve_store_options;
  std::shared_ptr<spdlog::logger> logger;
  SceneStore scenes;
  SolveStore solves;
  CallPools pools;
  const Tenants tenants;
  SceneService scene_service;
  SolveService solve_service;
  std::shared_ptr<Metrics> metrics;
};

Service::Service() : Service(ServiceOptions()) {}

Service::Service(ServiceOptions options) : parts_(std::make_unique<Parts>(options)) {}

Service::~Service() { shut_down(); }

void Service::register_with(grpc::ServerBuilder& builder) {
  builder.SetMaxReceiveMessageSize(largest_message);
  builder.RegisterService(&parts_->scene_service);
  builder.RegisterService(&parts_->solve_service);
  std::vector<std::unique_ptr<grpc::experimental::ServerInterceptorFactoryInterface>> interceptors;
  interceptors.push_back(counting_calls(parts_->calls));
  builder.experimental().SetInterceptorCreators(std::move(interceptors));
}

std::shared_ptr<prometheus::Collectable> Service::metrics() const { return parts_->metrics; }

void Service::shut_down() {
  for (WorkPool* pool : {&parts_->pools.building, &parts_->pools.importing, &parts_->pools.keeping, &parts_->pools.watching})
    pool->stop();
  parts_->watches.stop_all();
  parts_->solves.shut_down();
}

}  // namespace alvor
