#include "server/caller.h"

#include "server/random_id.h"
#include "server/status_error.h"

namespace alvor {

namespace {

std::string text(grpc::string_ref bytes) { return {bytes.data(), bytes.size()}; }

}  // namespace

std::string Tenants::of(const grpc::ServerContextBase& context) const {
  const auto& metadata = context.client_metadata();
  if (const auto told = metadata.find(tenant_key()); told != metadata.end()) return text(told->second);
  if (!identity_header_.empty() && context.peer().starts_with("unix:")) {
    const auto told = metadata.find(identity_header_);
    if (told != metadata.end() && !told->second.empty()) return text(told->second);
    if (!tokens_) throw StatusError(grpc::UNAUTHENTICATED, "the call says nothing of who it is from");
  }
  if (!tokens_) return {};
  const auto [first, end] = metadata.equal_range("authorization");
  return tokens_->caller_of(first == end ? "" : text(first->second));
}

std::string turn_of(const std::string& tenant, const grpc::ServerContextBase& context) {
  return tenant.empty() ? context.peer() : tenant;
}

const std::string& tenant_key() {
  static const std::string key = "alvor-tenant-" + random_id('k') + random_id('k') + "-bin";  // names may have any bytes
  return key;
}

}  // namespace alvor
