#pragma once
// Who calls, and what each may have.

#include <grpcpp/server_context.h>

#include <cstdint>
#include <string>

namespace alvor {

/// A tenant sees its own scenes and solves only. Without bearer tokens all callers are one tenant, "".
struct Caller {
  std::string tenant;
  std::string request_id;  ///< of a request that may be repeated; "": none
};

/// What one tenant may have at a time; beyond it requests are RESOURCE_EXHAUSTED.
struct Quota {
  std::uint64_t scenes = 10'000;
  std::uint64_t scene_bytes = std::uint64_t{50} << 30;  ///< of content, before compression
  std::uint64_t solves = 64;                            ///< that have not ended
  std::uint64_t leaves = 20'000'000;                    ///< that these may come to
  std::uint64_t watchers = 1000;
};

/// As the server's credentials found out, or a front end in this process.
std::string tenant_of(const grpc::ServerContextBase& context);

/// Metadata in which a front end in this process says for whom it calls. The key is as random as a secret: nobody else knows it.
const std::string& tenant_key();

}  // namespace alvor
