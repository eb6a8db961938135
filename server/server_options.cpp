#include "server/server_options.h"

#include <CLI/CLI.hpp>

#include <cctype>

namespace alvor {

namespace {

void declare_web(CLI::App& app, ServerOptions& options) {
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

/// Lets environment variables set options, as is usual for containers: ALVORD_LISTEN sets --listen.
void declare_variables(CLI::App& app) {
  for (CLI::Option* option : app.get_options()) {
    std::string name = "ALVORD_" + option->get_single_name();
    for (char& c : name) c = c == '-' ? '_' : static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    if (name != "ALVORD_HELP" && name != "ALVORD_VERSION" && name != "ALVORD_PROBE") option->envname(name);
  }
}

}  // namespace

void check(const ServerOptions& options) {
  credentials_of(options.listen);
  if (!options.listen.identity_header.empty() && !is_unix(options.listen.address) && !is_unix(options.web))
    throw std::invalid_argument("--identity-header is believed on Unix sockets alone: give --listen or --web unix:PATH");
}

void declare(CLI::App& app, ServerOptions& options) {
  app.set_version_flag("--version", "alvord " ALVOR_VERSION);
  ListenOptions& listen = options.listen;
  app.add_option("--listen", listen.address, "HOST:PORT or unix:PATH to listen on; port 0 takes a free one")
      ->capture_default_str();
  app.add_option("--max-connections", options.connections.in_all, "Connections to it at a time")->capture_default_str();
  app.add_option("--max-connections-by-address", options.connections.by_address, "The same, from one address of another machine")
      ->capture_default_str();
  app.add_option("--tls-cert", listen.certificate, "The server's certificate, and what it takes to trust it (PEM): TLS");
  app.add_option("--tls-key", listen.key, "The key of --tls-cert (PEM)");
  app.add_option("--tls-client-ca", listen.client_ca, "Clients must show a certificate signed by one of these (PEM)");
  app.add_option("--tokens", listen.tokens, "Calls must carry a bearer token of this file: lines NAME SHA256, see the README");
  app.add_option("--identity-header", listen.identity_header,
                 "Metadata by which a proxy says whose call it is; believed on Unix sockets alone");
  app.add_flag("--insecure", listen.insecure, "Listen for other machines without TLS");
  app.add_option("--data", options.directory,
                 "Directory for scenes, solves and their checkpoints; without it they end with the server");
  app.add_option("--checkpoint-interval", options.checkpoint_interval_s, "Seconds between checkpoints of a running solve")
      ->check(CLI::Range(0.05, 86400.0))
      ->capture_default_str();
  Quota& quota = options.quota;
  app.add_option("--quota-scenes", quota.scenes, "Scenes that each tenant may keep")->capture_default_str();
  app.add_option("--quota-bytes", quota.scene_bytes, "Bytes that these may come to")->capture_default_str();
  app.add_option("--quota-solves", quota.solves, "Solves of each tenant that have not ended")->capture_default_str();
  app.add_option("--quota-ended-solves", quota.ended_solves, "Solves of each tenant that have ended and are kept")
      ->capture_default_str();
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
  declare_variables(app);
}

}  // namespace alvor
