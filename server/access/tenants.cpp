#include "server/access/tenants.h"

#include "server/base/random_id.h"
#include "server/base/status_error.h"

namespace alvor {

namespace {

std::string text(grpc::string_ref bytes) { return {bytes.data(), bytes.size()}; }

}  // namespace

std::string Tenants::of(const grpc::ServerContextBase& context) const {
  const auto& metadata = context.client_metadata();
  if (const auto told = metadata.find(tenant_key()); told != metadata.end()) return text(told->second);
  const auto named = metadata.find(identity_header_);
  if (!identity_header_.empty() && named != metadata.end() && !named->second.empty() && context.peer().starts_with("unix"))
    return text(named->second);
  if (!tokens_ && !identity_header_.empty()) throw StatusError(grpc::UNAUTHENTICATED, "the call says nothing of who it is from");
  if (!tokens_) return {};
  const auto [first, end] = metadata.equal_range("authorization");
  return tokens_->caller_of(first == end ? "" : text(first->second));
}

std::string turn_of(const std::string& tenant, const grpc::ServerContextBase& context) {
  if (!tenant.empty()) return tenant;
  const std::string peer = context.peer();
  return peer.substr(0, peer.starts_with("ip") ? peer.rfind(':') : std::string::npos);
}

const std::string& tenant_key() {
  static const std::string key =
      "alvor-tenant-" + random_id('k') + random_id('k') + "-bin";  // -bin: the tenant's name may hold any bytes
  return key;
}

}  // namespace alvor
