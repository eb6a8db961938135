#include "server/listening.h"

#include "server/bearer_tokens.h"

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

/// Looks at every call, health checks and reflection too.
class TokenCheck final : public grpc::AuthMetadataProcessor {
 public:
  explicit TokenCheck(BearerTokens tokens) : tokens_(std::move(tokens)) {}

  grpc::Status Process(const InputMetadata& metadata, grpc::AuthContext* context, OutputMetadata* consumed,
                       OutputMetadata*) override {
    const auto found = metadata.find("authorization");
    if (found == metadata.end()) return {grpc::UNAUTHENTICATED, "authorization: is missing, must be 'Bearer TOKEN'"};
    const std::string value(found->second.data(), found->second.size());
    constexpr std::string_view scheme = "Bearer ";
    const auto holder =
        value.starts_with(scheme) ? tokens_.holder_of(std::string_view(value).substr(scheme.size())) : std::nullopt;
    if (!holder) return {grpc::UNAUTHENTICATED, "authorization: is not a token that this server knows"};
    context->AddProperty("tenant", *holder);
    consumed->emplace("authorization", value);
    return grpc::Status::OK;
  }

 private:
  const BearerTokens tokens_;
};

std::shared_ptr<grpc::ServerCredentials> tls_credentials(const ListenOptions& options) {
  grpc::SslServerCredentialsOptions tls(options.client_ca.empty() ? GRPC_SSL_DONT_REQUEST_CLIENT_CERTIFICATE
                                                                  : GRPC_SSL_REQUEST_AND_REQUIRE_CLIENT_CERTIFICATE_AND_VERIFY);
  tls.pem_key_cert_pairs.push_back({read("--tls-key", options.key), read("--tls-cert", options.certificate)});
  if (!options.client_ca.empty()) tls.pem_root_certs = read("--tls-client-ca", options.client_ca);
  return grpc::SslServerCredentials(tls);
}

std::shared_ptr<TokenCheck> token_check(const std::string& file) {
  const std::string text = read("--tokens", file);
  try {
    return std::make_shared<TokenCheck>(BearerTokens::parse(text));
  } catch (const std::invalid_argument& fault) {
    throw std::invalid_argument("--tokens: '" + file + "': " + fault.what());
  }
}

}  // namespace

std::shared_ptr<grpc::ServerCredentials> credentials_of(const ListenOptions& options) {
  if (options.certificate.empty() != options.key.empty()) throw std::invalid_argument("--tls-cert and --tls-key go together");
  const bool has_tls = !options.certificate.empty();
  if (!has_tls && !options.client_ca.empty()) throw std::invalid_argument("--tls-client-ca needs --tls-cert and --tls-key");
  if (!has_tls && !options.tokens.empty())
    throw std::invalid_argument("--tokens needs --tls-cert and --tls-key: tokens are secrets");
  if (!has_tls && !options.insecure && !is_loopback(options.address))
    throw std::invalid_argument("--listen " + options.address +
                                ": other machines could call without TLS; give --tls-cert and --tls-key, or say --insecure");
  if (!has_tls) return grpc::InsecureServerCredentials();
  const auto credentials = tls_credentials(options);
  if (!options.tokens.empty()) credentials->SetAuthMetadataProcessor(token_check(options.tokens));
  return credentials;
}

bool is_loopback(const std::string& address) {
  if (address.starts_with("unix:")) return true;
  const std::string host = address.substr(0, address.rfind(':'));
  const bool is_127 = host.starts_with("127.") && host.find_first_not_of("0123456789.") == std::string::npos;
  return is_127 || host == "localhost" || host == "[::1]";
}

}  // namespace alvor
