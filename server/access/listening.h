#pragma once
// Where a server listens, and whom it lets in.

#include "server/access/bearer_tokens.h"

#include <grpcpp/security/server_credentials.h>

#include <memory>
#include <optional>
#include <string>

namespace alvor {

struct ListenOptions {
  std::string address = "127.0.0.1:50051";  ///< HOST:PORT
  // Names of PEM files; without certificate and key there is no TLS.
  std::string certificate, key;
  std::string client_ca;  ///< clients must then show a certificate that it signed
  /// Name of a file as BearerTokens reads it: calls must then carry a token. Needs TLS where other machines can call.
  std::string tokens;
  /// Metadata in which a proxy says whose call it is, after it has checked the client's certificate. Trusted on Unix sockets
  /// alone.
  std::string identity_header;
  bool insecure = false;  ///< plaintext for other machines too
};

/// Throws std::invalid_argument naming the option: a file cannot be read or makes no sense, options contradict each other, or the
/// address is not of this machine alone and there is neither TLS nor leave to do without.
std::shared_ptr<grpc::ServerCredentials> credentials_of(const ListenOptions& options);

/// Nothing where all may call. Throws std::invalid_argument: the file cannot be read or is no such file.
std::optional<BearerTokens> tokens_of(const ListenOptions& options);

/// Throws std::invalid_argument naming the option where other machines could call at `address` without TLS, and nobody gave
/// leave.
void refuse_plaintext(const std::string& option, const std::string& address, const ListenOptions& options);

/// What is said where a port cannot be had.
std::string cannot_listen(const std::string& address);

/// HOST:PORT with the port that was taken.
std::string with_port(const std::string& address, int port);

/// Whether it is the path of a socket file: unix:PATH.
bool is_unix(const std::string& address);

/// Whether only this machine can call there: 127.0.0.0/8, ::1, localhost, a Unix socket.
bool is_loopback(const std::string& address);

}  // namespace alvor
