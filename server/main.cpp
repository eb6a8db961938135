// alvord: the Alvor server.

#include "server/health.h"
#include "server/listening.h"
#include "server/memory_guard.h"
#include "server/service.h"
#include "server/task_queue.h"
#include "server/web_front.h"

#include <google/protobuf/stubs/logging.h>
#include <grpc/support/log.h>
#include <grpcpp/ext/proto_server_reflection_plugin.h>
#include <grpcpp/grpcpp.h>
#include <prometheus/exposer.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <CLI/CLI.hpp>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

struct Options {
  alvor::ListenOptions listen;
  std::string directory;
  int max_solves = alvor::SolveStoreOptions{}.max_running;
  double checkpoint_interval_s = 10;
  std::string metrics;
  std::string health, probe;
  std::uint64_t memory_limit = alvor::allowed_memory();
  std::vector<std::string> web_origins;
  std::string web, page = (std::filesystem::read_symlink("/proc/self/exe").parent_path() / "web").string();
  alvor::Quota quota;
  std::string log_level = "info";
};

void declare_web(CLI::App& app, Options& options) {
  CLI::Option* web =
      app.add_option("--web", options.web, "HOST:PORT or unix:PATH to serve the page and gRPC-Web for browsers on (not at all)");
  app.add_option("--web-origin", options.web_origins,
                 "Pages of this origin, as https://room.example, may call there too; may be repeated (none)")
      ->needs(web)
      ->type_name("ORIGIN")
      ->delimiter(',')
      ->allow_extra_args(false);
  app.add_option("--page", options.page, "Directory of that page")->capture_default_str();
}

void declare(CLI::App& app, Options& options) {
  app.set_version_flag("--version", "alvord " ALVOR_VERSION);
  alvor::ListenOptions& listen = options.listen;
  app.add_option("--listen", listen.address, "HOST:PORT to listen on; port 0 takes a free one")->capture_default_str();
  app.add_option("--tls-cert", listen.certificate, "The server's certificate, and what it takes to trust it (PEM): TLS");
  app.add_option("--tls-key", listen.key, "The key of --tls-cert (PEM)");
  app.add_option("--tls-client-ca", listen.client_ca, "Clients must show a certificate signed by one of these (PEM)");
  app.add_option("--tokens", listen.tokens, "Calls must carry a bearer token of this file: lines NAME SHA256, see the README");
  app.add_flag("--insecure", listen.insecure, "Listen for other machines without TLS");
  app.add_option("--data", options.directory,
                 "Directory for scenes, solves and their checkpoints; without it they end with the server");
  app.add_option("--checkpoint-interval", options.checkpoint_interval_s, "Seconds between checkpoints of a running solve")
      ->check(CLI::Range(0.05, 86400.0))
      ->capture_default_str();
  alvor::Quota& quota = options.quota;
  app.add_option("--quota-scenes", quota.scenes, "Scenes that each tenant may keep")->capture_default_str();
  app.add_option("--quota-bytes", quota.scene_bytes, "Bytes that these may come to")->capture_default_str();
  app.add_option("--quota-solves", quota.solves, "Solves of each tenant that have not ended")->capture_default_str();
  app.add_option("--quota-leaves", quota.leaves, "Leaves that these may come to")->capture_default_str();
  app.add_option("--quota-watchers", quota.watchers, "Watches that each tenant may hold open")->capture_default_str();
  app.add_option("--max-solves", options.max_solves, "Solves that may run at a time")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_option(
         "--memory-limit", options.memory_limit,
         "Bytes (also K, M, G) at which work is refused or ends, before the system would end the server; 0 for none; else "
         "what the control group or the machine has")
      ->transform(CLI::AsSizeValue(false))
      ->capture_default_str();
  app.add_option("--health", options.health,
                 "HOST:PORT to tell health on (grpc.health.v1), without TLS and tokens, for probes (only where calls are taken)");
  app.add_option("--probe", options.probe, "Only ask a server's --health HOST:PORT; fails unless it serves");
  app.add_option("--metrics", options.metrics, "HOST:PORT to tell Prometheus on, at /metrics (not at all)");
  declare_web(app, options);
  app.add_option("--log-level", options.log_level, "How much to log")
      ->check(CLI::IsMember({"debug", "info", "warning", "error", "off"}))
      ->capture_default_str();
  // Containers are told by variables: ALVORD_LISTEN is --listen.
  for (CLI::Option* option : app.get_options()) {
    std::string name = "ALVORD_" + option->get_single_name();
    for (char& c : name) c = c == '-' ? '_' : static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    if (name != "ALVORD_HELP" && name != "ALVORD_VERSION" && name != "ALVORD_PROBE") option->envname(name);
  }
}

std::shared_ptr<spdlog::logger> make_logger(const std::string& level) {
  auto logger = spdlog::stderr_color_mt("alvord");
  logger->set_level(spdlog::level::from_str(level));
  logger->flush_on(spdlog::level::info);
  return logger;
}

// The libraries' own messages are for those who debug it; what a user needs to know is said here.
void quieten_grpc() {
  gpr_set_log_function([](gpr_log_func_args* line) {
    if (const auto logger = spdlog::get("alvord")) logger->debug("grpc: {}", line->message);
  });
  google::protobuf::SetLogHandler([](google::protobuf::LogLevel, const char*, int, const std::string& line) {
    if (const auto logger = spdlog::get("alvord")) logger->debug("protobuf: {}", line);
  });
}

// Must be called before any thread is started: threads inherit the mask, and only wait_for_stop sees the signals.
sigset_t block_stop_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  return signals;
}

std::string wait_for_stop(const sigset_t& signals) {
  int number = 0;
  while (sigwait(&signals, &number) != 0) {}
  return number == SIGINT ? "SIGINT" : "SIGTERM";
}

// Null if it cannot listen there. Two servers must not share a port unknowingly, and a peer that vanished without a word
// must not keep its watches for ever. A break of 5 s is outlived: TCP sends again until 6.3 s after it began.
std::unique_ptr<grpc::Server> start(alvor::Service& service, const alvor::ListenOptions& listen, int& port) {
  grpc::EnableDefaultHealthCheckService(true);
  grpc::reflection::InitProtoReflectionServerBuilderPlugin();
  grpc::ServerBuilder builder;
  builder.AddChannelArgument(GRPC_ARG_ALLOW_REUSEPORT, 0);
  builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_TIME_MS, 10'000);
  builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_TIMEOUT_MS, 10'000);
  builder.AddChannelArgument(GRPC_ARG_HTTP2_MIN_RECV_PING_INTERVAL_WITHOUT_DATA_MS, 5'000);  // clients may do as much
  builder.AddListeningPort(listen.address, alvor::credentials_of(listen), &port);
  service.register_with(builder);
  auto server = builder.BuildAndStart();
  return port > 0 ? std::move(server) : nullptr;
}

// Those who ask about health are told first; what is under way then ends.
void stop(alvor::Service& service, grpc::Server& server, alvor::HealthPort* health) {
  using namespace std::chrono_literals;
  if (health) alvor::set_serving(health->server(), false);
  alvor::set_serving(server, false);
  service.shut_down();
  server.Shutdown(std::chrono::system_clock::now() + 3s);
}

std::chrono::steady_clock::duration seconds(double s) {
  return std::chrono::duration_cast<std::chrono::steady_clock::duration>(std::chrono::duration<double>(s));
}

/// Notes every second that the server is alive, so that the next one can tell how much work was lost.
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

// Null without an address.
std::unique_ptr<prometheus::Exposer> expose(const std::string& address, const alvor::Service& service) {
  if (address.empty()) return nullptr;
  try {
    auto exposer = std::make_unique<prometheus::Exposer>(address);
    exposer->RegisterCollectable(service.metrics());
    return exposer;
  } catch (const std::exception&) {
    throw std::invalid_argument("--metrics: " + alvor::cannot_listen(address));
  }
}

// Null without an address.
std::unique_ptr<alvor::WebFront> serve_web(const Options& options, grpc::Server& server, spdlog::logger& logger) {
  if (options.web.empty()) return nullptr;
  const alvor::WebOptions web{options.web, options.page, &options.listen, options.web_origins};
  auto front = std::make_unique<alvor::WebFront>(web, server.InProcessChannel({}));
  logger.info("web page on {}", front->url());
  return front;
}

// Null without an address.
std::unique_ptr<alvor::HealthPort> serve_health(const std::string& address, spdlog::logger& logger) {
  if (address.empty()) return nullptr;
  auto health = std::make_unique<alvor::HealthPort>(address);
  logger.info("health on {}", alvor::with_port(address, health->port()));
  return health;
}

int serve(const Options& options, const sigset_t& signals, const std::shared_ptr<spdlog::logger>& logger) {
  alvor::ServiceOptions service_options;
  service_options.solves.max_running = options.max_solves;
  service_options.solves.logger = logger;
  service_options.solves.keeping.interval = seconds(options.checkpoint_interval_s);
  service_options.quota = options.quota;
  service_options.memory = alvor::MemoryGuard(options.memory_limit);
  if (auto tokens = alvor::tokens_of(options.listen))
    service_options.tokens = std::make_shared<const alvor::BearerTokens>(*std::move(tokens));
  std::unique_ptr<alvor::Archive> archive;
  if (!options.directory.empty()) archive = std::make_unique<alvor::Archive>(options.directory);
  service_options.archive = archive.get();
  alvor::Service service(service_options);
  const auto health = serve_health(options.health, *logger);
  int port = 0;
  const auto server = start(service, options.listen, port);
  if (!server) {
    std::cerr << "alvord: " << alvor::cannot_listen(options.listen.address) << '\n';
    return 1;
  }
  const auto exposer = expose(options.metrics, service);
  const auto web = serve_web(options, *server, *logger);
  alvor::set_serving(*server, true);
  if (health) alvor::set_serving(health->server(), true);
  const Heartbeat heartbeat(archive.get());
  logger->info("listening on {}", alvor::with_port(options.listen.address, port));
  logger->info("stopping: {}", wait_for_stop(signals));
  stop(service, *server, health.get());
  logger->info("stopped");
  return 0;
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
  Options options;
  declare(app, options);
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
