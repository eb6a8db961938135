#pragma once
// Identifies the caller of a request, and limits what each tenant may have.

#include <cstdint>
#include <string>

namespace alvor {

/// The tenant that calls. A tenant sees only its own scenes and solves. Without bearer tokens all callers are one tenant, "".
struct Caller {
  std::string tenant;
  std::string request_id;  ///< id under which the request may be repeated; "": none
};

/// Limits for one tenant. A request beyond one of them fails with RESOURCE_EXHAUSTED.
struct Quota {
  std::uint64_t scenes = 10'000;
  std::uint64_t scene_bytes = std::uint64_t{50} << 30;  ///< content of all scenes, before compression
  std::uint64_t solves = 64;                            ///< solves that have not ended
  std::uint64_t ended_solves = 10'000;                  ///< solves that have ended and are kept
  std::uint64_t leaves = 20'000'000;                    ///< upper limit of the leaves of all solves that have not ended
  std::uint64_t watchers = 1000;                        ///< watches open at a time
};

}  // namespace alvor
