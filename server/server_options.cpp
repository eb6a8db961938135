#include "server/server_options.h"

#include <CLI/CLI.hpp>

#include <cctype>

namespace alvor {

namespace {

void declare_web(CLI::App& app, ServerOptions& options) {
  CLI::Option* web =
      app.add_option("--web", options.web, "HOST:PORT or unix:PATH on which to serve the web page and gRPC-Web (not at all)");
  app.add_option("--web-origin", options.web_origins,
                 "Also accept calls from pages of this origin, such as https://room.example; may be repeated (none)")
      ->needs(web)
      ->type_name("ORIGIN")
      ->delimiter(',')
      ->allow_extra_args(false);
  app.add_option("--page", options.page, "Directory with the files of the web page")->capture_default_str();
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
  app.add_option("--max-connections", options.connections.in_all, "Most open gRPC connections at a time")->capture_default_str();
  app.add_option("--max-connections-by-address", options.connections.by_address,
                 "Most open gRPC connections from one address of another machine")
      ->capture_default_str();
  app.add_option("--tls-cert", listen.certificate, "Use TLS with this certificate, followed by its chain (PEM)");
  app.add_option("--tls-key", listen.key, "Private key of --tls-cert (PEM)");
  app.add_option("--tls-client-ca", listen.client_ca, "Require client certificates signed by one of these CAs (PEM)");
  app.add_option("--tokens", listen.tokens, "Require a bearer token that this file lists: lines NAME SHA256, see the README");
  app.add_option("--identity-header", listen.identity_header,
                 "Metadata key in which a proxy names the caller; trusted only on Unix sockets");
  app.add_flag("--insecure", listen.insecure, "Allow other machines to connect without TLS");
  app.add_option(
      "--data", options.directory,
      "Directory that keeps scenes, solves and checkpoints across restarts; without it they are lost when the server ends");
  app.add_option("--checkpoint-interval", options.checkpoint_interval_s, "Seconds between checkpoints of a running solve")
      ->check(CLI::Range(0.05, 86400.0))
      ->capture_default_str();
  Quota& quota = options.quota;
  app.add_option("--quota-scenes", quota.scenes, "Most scenes of each tenant")->capture_default_str();
  app.add_option("--quota-bytes", quota.scene_bytes, "Most bytes of all scenes of each tenant, before compression")
      ->capture_default_str();
  app.add_option("--quota-solves", quota.solves, "Most solves of each tenant that have not ended")->capture_default_str();
  app.add_option("--quota-ended-solves", quota.ended_solves, "Most ended solves of each tenant that are kept")
      ->capture_default_str();
  app.add_option("--quota-leaves", quota.leaves, "Most leaves that all unfinished solves of each tenant may come to")
      ->capture_default_str();
  app.add_option("--quota-watchers", quota.watchers, "Most open watches of each tenant")->capture_default_str();
  app.add_option("--max-solves", options.max_solves, "Most solves that run at a time")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_option("--gang", options.gang,
                 "Started as several ranks (mpirun): how many of them share in the work of each solve (by the size of its scene)")
      ->check(CLI::Range(1, 65535));
  app.add_option(
         "--memory-limit", options.memory_limit,
         "Memory in bytes (also K, M, G) near which new work is refused and solves are ended, before the system would kill the "
         "server; 0: no limit (the limit of the control group or the machine)")
      ->transform(CLI::AsSizeValue(false))
      ->capture_default_str();
  app.add_option("--health", options.health,
                 "HOST:PORT that answers only health checks (grpc.health.v1), without TLS and tokens (health only on --listen)");
  app.add_option("--probe", options.probe,
                 "Start no server; check the --health HOST:PORT of a running one and fail unless it serves");
  app.add_option("--metrics", options.metrics, "HOST:PORT on which to serve Prometheus metrics at /metrics (not at all)");
  declare_web(app, options);
  app.add_option("--importer", options.importer, "The program alvor-import, which reads scene files")->capture_default_str();
  app.add_option("--log-level", options.log_level, "Log messages of this level and above")
      ->check(CLI::IsMember({"debug", "info", "warning", "error", "off"}))
      ->capture_default_str();
  declare_variables(app);
}

}  // namespace alvor
