#pragma once
// Finds out which tenant a call belongs to.

#include "server/access/bearer_tokens.h"

#include <grpcpp/server_context.h>

#include <memory>
#include <string>

namespace alvor {

/// Finds out the tenant of a call from the call's own metadata: calls of many tenants share one connection, and gRPC's
/// AuthContext belongs to the connection. Immutable; safe from any thread.
class Tenants {
 public:
  /// Without tokens (null) and without `identity_header` ("") all callers are one tenant.
  explicit Tenants(std::shared_ptr<const BearerTokens> tokens, std::string identity_header = {})
      : tokens_(std::move(tokens)), identity_header_(std::move(identity_header)) {}

  /// Returns the tenant of a call: as named by a front end in this process; else, over a Unix socket, by the identity header;
  /// else by the call's token. Throws StatusError UNAUTHENTICATED.
  std::string of(const grpc::ServerContextBase& context) const;

 private:
  std::shared_ptr<const BearerTokens> tokens_;
  const std::string identity_header_;
};

/// Returns the name under which calls take turns: the tenant, or without tokens the address that the call came from.
std::string turn_of(const std::string& tenant, const grpc::ServerContextBase& context);

/// Returns the metadata key under which a front end in this process names the tenant. The key is random, so that no client can
/// know it.
const std::string& tenant_key();

}  // namespace alvor
