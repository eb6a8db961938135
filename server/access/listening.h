#pragma once
// Options of a listening address, and which clients may connect there.

#include "server/access/bearer_tokens.h"

#include <grpcpp/security/server_credentials.h>

#include <memory>
#include <optional>
#include <string>

namespace alvor {

struct ListenOptions {
  std::string address = "127.0.0.1:50051";  ///< HOST:PORT
  // Names of PEM files. Without certificate and key there is no TLS.
  std::string certificate, key;
  std::string client_ca;  ///< if set, clients must show a certificate that this CA signed
  /// Name of a file for BearerTokens; if set, calls must carry a token. Needs TLS if other machines can call.
  std::string tokens;
  /// Metadata key under which a proxy names the caller, after it has checked the client's certificate. Trusted only on Unix
  /// sockets.
  std::string identity_header;
  bool insecure = false;  ///< allows plaintext for other machines too
};

/// Returns the credentials for these options. Throws std::invalid_argument naming the option if a file cannot be read or is
/// malformed, if options contradict each other, or if other machines can call, there is no TLS and `insecure` is not set.
std::shared_ptr<grpc::ServerCredentials> credentials_of(const ListenOptions& options);

/// Returns the tokens, or nothing if calls need none. Throws std::invalid_argument if the file cannot be read or is malformed.
std::optional<BearerTokens> tokens_of(const ListenOptions& options);

/// Throws std::invalid_argument naming `option` if other machines could call at `address` without TLS and `insecure` is not set.
void refuse_plaintext(const std::string& option, const std::string& address, const ListenOptions& options);

/// Returns the error message for an address on which the server cannot listen.
std::string cannot_listen(const std::string& address);

/// Returns HOST:PORT with the port that the system assigned.
std::string with_port(const std::string& address, int port);

/// Returns whether `address` is the path of a socket file: unix:PATH.
bool is_unix(const std::string& address);

/// Returns whether only this machine can connect to `address`: 127.0.0.0/8, ::1, localhost, a Unix socket.
bool is_loopback(const std::string& address);

}  // namespace alvor
