// The main program of alvord, the Alvor server.

#include "radiosity/ranks/launched_ranks.h"
#include "server/access/listening.h"
#include "server/base/descriptor_limit.h"
#include "server/base/memory_guard.h"
#include "server/base/task_queue.h"
#include "server/rpc/health.h"
#include "server/rpc/metrics.h"
#include "server/rpc/rpc_server.h"
#include "server/rpc/self_probe.h"
#include "server/rpc/service.h"
#include "server/server_options.h"
#include "server/solves/solving_ranks.h"
#include "server/web/web_front.h"

#include <google/protobuf/stubs/logging.h>
#include <grpc/support/log.h>
#include <grpcpp/ext/proto_server_reflection_plugin.h>
#include <grpcpp/grpcpp.h>
#include <prometheus/exposer.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

// When memory is short, a connection that received more than this within seconds is ended as a flood. New scenes are refused long
// before memory is that short.
constexpr std::uint64_t much_received = 8 << 20;
constexpr std::uint64_t least_rpc_memory = 64 << 20;  // for gRPC's connections; one message may take as much

std::atomic<bool> listener_died = false;

std::shared_ptr<spdlog::logger> make_logger(const std::string& level) {
  auto logger = spdlog::stderr_color_mt("alvord");
  logger->set_level(spdlog::level::from_str(level));
  logger->flush_on(spdlog::level::info);
  return logger;
}

// Redirects messages of gRPC and protobuf to the debug log; the server reports by itself what a user needs to know.
void quieten_grpc() {
  gpr_set_log_function([](gpr_log_func_args* line) {
    if (const auto logger = spdlog::get("alvord")) logger->debug("grpc: {}", line->message);
  });
  google::protobuf::SetLogHandler([](google::protobuf::LogLevel, const char*, int, const std::string& line) {
    if (const auto logger = spdlog::get("alvord")) logger->debug("protobuf: {}", line);
  });
}

// Blocks SIGINT and SIGTERM. Must be called before any thread is started: threads inherit the mask, so that only wait_for_stop
// receives the signals.
sigset_t block_stop_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  std::signal(SIGPIPE, SIG_IGN);  // a write to a lost connection then returns an error
  return signals;
}

std::string wait_for_stop(const sigset_t& signals) {
  int number = 0;
  while (sigwait(&signals, &number) != 0) {}
  return number == SIGINT ? "SIGINT" : "SIGTERM";
}

std::unique_ptr<alvor::RpcServer> start(alvor::Service& service, const alvor::ServerOptions& options,
                                        std::shared_ptr<alvor::FrontDoor> door, spdlog::logger& logger) {
  grpc::reflection::InitProtoReflectionServerBuilderPlugin();
  const auto configure = [&](grpc::ServerBuilder& builder) {
    if (options.memory_limit > 0)
      builder.SetResourceQuota(grpc::ResourceQuota("alvord").Resize(std::max(options.memory_limit / 8, least_rpc_memory)));
    service.register_with(builder);
  };
  // A server that cannot accept connections ends, so that its supervisor restarts it.
  const auto died = [&logger] {
    logger.critical("no connection can be accepted any more");
    listener_died = true;
    kill(getpid(), SIGTERM);
  };
  return std::make_unique<alvor::RpcServer>(std::move(door), alvor::credentials_of(options.listen), configure, died);
}

void tell_health(bool is_serving, alvor::RpcServer& rpc, alvor::HealthPort* health) {
  alvor::set_serving(rpc.server(), is_serving);
  if (health) alvor::set_serving(health->server(), is_serving);
}

// Reports NOT_SERVING first, so that load balancers send no new calls; then ends the calls under way.
void stop(alvor::Service& service, alvor::RpcServer& rpc, alvor::HealthPort* health) {
  tell_health(false, rpc, health);
  service.shut_down();
  rpc.shut_down(std::chrono::seconds(3));
}

std::chrono::steady_clock::duration seconds(double s) {
  return std::chrono::duration_cast<std::chrono::steady_clock::duration>(std::chrono::duration<double>(s));
}

/// Records every second that the server is alive, so that the next start can tell how much work was lost.
class Heartbeat {
 public:
  explicit Heartbeat(alvor::Archive* archive) : archive_(archive) {
    if (archive_) beat();
  }

 private:
  void beat() {
    archive_->note_alive();
    tasks_.post_at(alvor::TaskQueue::Clock::now() + std::chrono::seconds(1), [this] { beat(); });
  }
  alvor::Archive* const archive_;
  alvor::TaskQueue tasks_;
};

// Returns the server of metrics, or null without an address.
std::unique_ptr<prometheus::Exposer> expose(const std::string& address, const alvor::Service& service,
                                            const std::vector<std::shared_ptr<prometheus::Collectable>>& others) {
  if (address.empty()) return nullptr;
  try {
    auto exposer = std::make_unique<prometheus::Exposer>(address);
    exposer->RegisterCollectable(service.metrics());
    for (const auto& each : others)
      if (each) exposer->RegisterCollectable(each);
    return exposer;
  } catch (const std::exception&) {
    throw std::invalid_argument("--metrics: " + alvor::cannot_listen(address));
  }
}

// Returns the server of the web page, or null without an address.
std::unique_ptr<alvor::WebFront> serve_web(const alvor::ServerOptions& options, std::size_t descriptors, grpc::Server& server,
                                           spdlog::logger& logger) {
  if (options.web.empty()) return nullptr;
  alvor::WebOptions web{options.web, options.page, &options.listen, options.web_origins, options.listen.identity_header, {}};
  web.limits.connections = alvor::bounded_connections(web.limits.connections, 0.25, descriptors);
  auto front = std::make_unique<alvor::WebFront>(web, server.InProcessChannel({}));
  logger.info("web page on {}", front->url());
  return front;
}

// Returns the server of health checks, or null without an address.
std::unique_ptr<alvor::HealthPort> serve_health(const std::string& address, std::size_t descriptors, spdlog::logger& logger) {
  if (address.empty()) return nullptr;
  auto health = std::make_unique<alvor::HealthPort>(address, alvor::bounded_connections(50, 0.05, descriptors));
  logger.info("health on {}", health->address());
  return health;
}

alvor::ServiceOptions service_options(const alvor::ServerOptions& options, const std::shared_ptr<spdlog::logger>& logger,
                                      alvor::Archive* archive, std::shared_ptr<alvor::FrontDoor> door,
                                      alvor::SolvingRanks& ranks) {
  alvor::ServiceOptions service;
  service.solves.max_running = options.max_solves;
  ranks.solve_for(service.solves);
  service.solves.logger = logger;
  service.solves.spare_solves = [door] { return door->end_greediest(much_received); };
  service.flooding = [door, logger](const std::string& peer) {
    if (door->end(peer)) logger->warn("closed the connection of {}: it began too many calls", peer);
  };
  service.solves.keeping.interval = seconds(options.checkpoint_interval_s);
  service.solves.keeping.keeps_live = true;
  service.quota = options.quota;
  service.memory = alvor::MemoryGuard(options.memory_limit);
  service.archive = archive;
  service.upload.importer.program = options.importer;
  service.identity_header = options.listen.identity_header;
  if (auto tokens = alvor::tokens_of(options.listen))
    service.tokens = std::make_shared<const alvor::BearerTokens>(*std::move(tokens));
  return service;
}

int serve(alvor::ServerOptions options, const sigset_t& signals, const std::shared_ptr<spdlog::logger>& logger) {
  auto launched = alvor::launched_ranks();
  // Ranks of one machine share its memory, unless somebody said what each may use.
  if (launched && options.memory_limit == alvor::allowed_memory()) options.memory_limit /= launched->ranks_on_this_machine();
  alvor::SolvingRanks ranks(std::move(launched), {options.gang, alvor::MemoryGuard(options.memory_limit)});
  if (!ranks.is_first()) {
    ranks.follow();
    return 0;
  }
  const std::size_t descriptors = alvor::raise_descriptor_limit();
  alvor::ConnectionLimits limits = options.connections;
  limits.in_all = alvor::bounded_connections(limits.in_all, 0.5, descriptors);
  alvor::check(options);
  const auto door = std::make_shared<alvor::FrontDoor>(options.listen.address, limits);
  std::unique_ptr<alvor::Archive> archive;
  if (!options.directory.empty()) archive = std::make_unique<alvor::Archive>(options.directory);
  alvor::Service service(service_options(options, logger, archive.get(), door, ranks));
  const auto health = serve_health(options.health, descriptors, *logger);
  const auto rpc = start(service, options, door, *logger);
  const auto door_metrics = std::make_shared<alvor::DoorMetrics>(*door);  // kept here, because the exposer does not keep it
  const auto rank_metrics = ranks.size() > 1 ? std::make_shared<alvor::RankMetrics>(ranks) : nullptr;
  const auto exposer = expose(options.metrics, service, {door_metrics, rank_metrics});
  const auto web = serve_web(options, descriptors, rpc->server(), *logger);
  tell_health(true, *rpc, health.get());
  const Heartbeat heartbeat(archive.get());
  alvor::SelfProbe self_probe(*door, !options.listen.certificate.empty(), [&](bool is_answered) {
    logger->log(is_answered ? spdlog::level::info : spdlog::level::err, "new connections are {}",
                is_answered ? "served again" : "not served");
    tell_health(is_answered, *rpc, health.get());
  });
  logger->info("{} descriptors; at most {} connections, {} of one address", descriptors, limits.in_all, limits.by_address);
  if (ranks.size() > 1) logger->info("{} ranks solve at most {} scenes at a time", ranks.size(), ranks.most_gangs());
  logger->info("listening on {}", rpc->address());
  logger->info("stopping: {}", wait_for_stop(signals));
  self_probe.stop();
  stop(service, *rpc, health.get());
  logger->info("stopped");
  return listener_died ? 1 : 0;
}

int probe(const std::string& address) {
  const std::string fault = alvor::probe_health(address);
  if (!fault.empty()) std::cerr << "alvord: not serving: " << fault << '\n';
  return fault.empty() ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  const sigset_t signals = block_stop_signals();
  CLI::App app("The Alvor server: holds scenes, solves their light exchange and streams the growing solution.", "alvord");
  alvor::ServerOptions options;
  alvor::declare(app, options);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  const auto logger = make_logger(options.log_level);
  quieten_grpc();
  if (!options.probe.empty()) return probe(options.probe);
  try {
    return serve(options, signals, logger);
  } catch (const std::invalid_argument& fault) {
    std::cerr << "alvord: " << fault.what() << '\n';
    return 2;
  } catch (const std::exception& fault) {
    std::cerr << "alvord: " << fault.what() << '\n';
    return 1;
  }
}
