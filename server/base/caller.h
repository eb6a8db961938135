#pragma once
// Who calls, and what each may have.

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
  std::uint64_t ended_solves = 10'000;                  ///< that are kept
  std::uint64_t leaves = 20'000'000;                    ///< that solves which have not ended may come to
  std::uint64_t watchers = 1000;
};

}  // namespace alvor
