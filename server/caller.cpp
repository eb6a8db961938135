#include "server/caller.h"

#include "server/random_id.h"

namespace alvor {

namespace {

std::string text(grpc::string_ref bytes) { return {bytes.data(), bytes.size()}; }

}  // namespace

std::string tenant_of(const grpc::ServerContextBase& context) {
  const auto auth = context.auth_context();
  const auto found = auth ? auth->FindPropertyValues("tenant") : std::vector<grpc::string_ref>{};
  if (!found.empty()) return text(found.front());
  const auto told = context.client_metadata().find(tenant_key());
  return told == context.client_metadata().end() ? "" : text(told->second);
}

const std::string& tenant_key() {
  static const std::string key = "alvor-tenant-" + random_id('k') + random_id('k') + "-bin";  // names may have any bytes
  return key;
}

}  // namespace alvor
