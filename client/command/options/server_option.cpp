#include "client/command/options/server_option.h"

namespace alvor {

CLI::Option& add_server_option(CLI::App& command, ServerChoice& server, const std::string& description) {
  CLI::Option* address = command.add_option("--server", server.address, description)->type_name("HOST:PORT");
  const auto add_file = [&](const char* name, std::string& file, const char* what) {
    return command.add_option(name, file, what)->check(CLI::ExistingFile)->type_name("FILE")->needs(address);
  };
  CLI::Option* ca = add_file("--tls-ca", server.ca, "Use TLS; certificate of the CA that signed the server's certificate (PEM)");
  CLI::Option* key = add_file("--tls-key", server.key, "Private key of --tls-cert (PEM)")->needs(ca);
  CLI::Option* certificate = add_file("--tls-cert", server.certificate, "Client certificate for the server (PEM)")->needs(ca);
  key->needs(certificate);
  certificate->needs(key);
  add_file("--token-file", server.token_file, "File with the bearer token for the server")->needs(ca);
  command.add_option("--patience", server.patience_s, "Seconds to keep trying after the connection to the server is lost")
      ->check(CLI::Range(0.0, 1e6))
      ->needs(address)
      ->capture_default_str();
  return *address;
}

}  // namespace alvor
