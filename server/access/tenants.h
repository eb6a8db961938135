#pragma once
// Whose call it is.

#include "server/access/bearer_tokens.h"

#include <grpcpp/server_context.h>

#include <memory>
#include <string>

namespace alvor {

/// Finds out whose call it is, from the metadata of that call alone: calls of many tenants come over one connection, and what
/// gRPC keeps of a connection (its AuthContext) is shared by them all. Immutable; safe from any thread.
class Tenants {
 public:
  /// Without tokens (null) and without `identity_header` ("") all callers are one tenant.
  explicit Tenants(std::shared_ptr<const BearerTokens> tokens, std::string identity_header = {})
      : tokens_(std::move(tokens)), identity_header_(std::move(identity_header)) {}

  /// The tenant as a front end in this process tells it; else, of a call over a Unix socket, as the identity header tells it;
  /// else by the call's token. Throws StatusError: UNAUTHENTICATED.
  std::string of(const grpc::ServerContextBase& context) const;

 private:
  std::shared_ptr<const BearerTokens> tokens_;
  const std::string identity_header_;
};

/// Whose turn it is where callers take turns: the tenant, or without tokens the address that the call came from.
std::string turn_of(const std::string& tenant, const grpc::ServerContextBase& context);

/// Metadata in which a front end in this process says for whom it calls. The key is as random as a secret: nobody else knows it.
const std::string& tenant_key();

}  // namespace alvor
