#include "server/access/listening.h"

#include "server/base/status_error.h"

#include <grpcpp/security/auth_metadata_processor.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace alvor {

namespace {

std::string read(const std::string& option, const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  std::string text;
  if (!std::filesystem::is_directory(file)) text.assign(std::istreambuf_iterator<char>(in), {});
  if (!in || text.empty()) throw std::invalid_argument(option + ": '" + file + "' cannot be read or is empty");
  return text;
}

/// Refuses calls without a valid token, also health checks and reflection. It does not record the caller: what is added to
/// `context` holds for all calls of the connection. Services find the caller by Tenants.
class TokenCheck final : public grpc::AuthMetadataProcessor {
 public:
  /// Calls with `identity_header`, if it is not empty, need no token.
  TokenCheck(BearerTokens tokens, std::string identity_header)
      : tokens_(std::move(tokens)), identity_header_(std::move(identity_header)) {}

  grpc::Status Process(const InputMetadata& metadata, grpc::AuthContext*, OutputMetadata*, OutputMetadata*) override {
    if (!identity_header_.empty() && !value_of(metadata, identity_header_).empty()) return grpc::Status::OK;
    try {
      tokens_.caller_of(value_of(metadata, "authorization"));
    } catch (const StatusError& refusal) {
      return {refusal.code, refusal.what()};
    }
    return grpc::Status::OK;
  }

 private:
  static std::string value_of(const InputMetadata& metadata, const std::string& key) {
    const auto found = metadata.find(key);
    return found == metadata.end() ? "" : std::string(found->second.data(), found->second.size());
  }

  const BearerTokens tokens_;
  const std::string identity_header_;
};

std::shared_ptr<grpc::ServerCredentials> tls_credentials(const ListenOptions& options) {
  grpc::SslServerCredentialsOptions tls(options.client_ca.empty() ? GRPC_SSL_DONT_REQUEST_CLIENT_CERTIFICATE
                                                                  : GRPC_SSL_REQUEST_AND_REQUIRE_CLIENT_CERTIFICATE_AND_VERIFY);
  tls.pem_key_cert_pairs.push_back({read("--tls-key", options.key), read("--tls-cert", options.certificate)});
  if (!options.client_ca.empty()) tls.pem_root_certs = read("--tls-client-ca", options.client_ca);
  return grpc::SslServerCredentials(tls);
}

/// Returns credentials for plaintext with TokenCheck, which InsecureServerCredentials does not accept.
std::shared_ptr<grpc::ServerCredentials> local_credentials(const ListenOptions& options) {
  return grpc::experimental::LocalServerCredentials(is_unix(options.address) ? UDS : LOCAL_TCP);
}

void check_identity_header(const ListenOptions& options) {
  const std::string& name = options.identity_header;
  if (name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-") != std::string::npos)
    throw std::invalid_argument("--identity-header: '" + name + "' is not of the characters a-z, 0-9 and -");
  if (name == "authorization" || name.starts_with("grpc-"))
    throw std::invalid_argument("--identity-header: '" + name + "' is taken");
}

}  // namespace

std::optional<BearerTokens> tokens_of(const ListenOptions& options) {
  if (options.tokens.empty()) return std::nullopt;
  const std::string text = read("--tokens", options.tokens);
  try {
    return BearerTokens::parse(text);
  } catch (const std::invalid_argument& fault) {
    throw std::invalid_argument("--tokens: '" + options.tokens + "': " + fault.what());
  }
}

void refuse_plaintext(const std::string& option, const std::string& address, const ListenOptions& options) {
  if (options.certificate.empty() && !options.insecure && !is_loopback(address))
    throw std::invalid_argument(option + " " + address +
                                ": other machines could call without TLS; give --tls-cert and --tls-key, or say --insecure");
}

std::shared_ptr<grpc::ServerCredentials> credentials_of(const ListenOptions& options) {
  if (options.certificate.empty() != options.key.empty()) throw std::invalid_argument("--tls-cert and --tls-key go together");
  const bool has_tls = !options.certificate.empty();
  if (!has_tls && !options.client_ca.empty()) throw std::invalid_argument("--tls-client-ca needs --tls-cert and --tls-key");
  if (!has_tls && !options.tokens.empty() && !is_loopback(options.address))
    throw std::invalid_argument("--tokens needs --tls-cert and --tls-key where other machines can call: tokens are secrets");
  check_identity_header(options);
  refuse_plaintext("--listen", options.address, options);
  if (!has_tls && options.tokens.empty()) return grpc::InsecureServerCredentials();
  const auto credentials = has_tls ? tls_credentials(options) : local_credentials(options);
  if (auto tokens = tokens_of(options))
    credentials->SetAuthMetadataProcessor(
        std::make_shared<TokenCheck>(*std::move(tokens), is_unix(options.address) ? options.identity_header : ""));
  return credentials;
}

std::string cannot_listen(const std::string& address) {
  return "cannot listen on " + address + ": the address is in use or not of this machine";
}

std::string with_port(const std::string& address, int port) {
  return address.substr(0, address.rfind(':') + 1) + std::to_string(port);
}

bool is_unix(const std::string& address) { return address.starts_with("unix:"); }

bool is_loopback(const std::string& address) {
  if (is_unix(address)) return true;
  const std::string host = address.substr(0, address.rfind(':'));
  const bool is_127 = host.starts_with("127.") && host.find_first_not_of("0123456789.") == std::string::npos;
  return is_127 || host == "localhost" || host == "[::1]";
}

}  // namespace alvor
