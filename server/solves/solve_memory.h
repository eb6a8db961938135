#pragma once
// How much memory solves take.

#include "server/scenes/scene_store.h"

#include <cstdint>

namespace alvor {

/// Bytes for each face of a solve that has begun: its part of the scene, mesh, tree of boxes and first rows.
inline constexpr std::uint64_t bytes_a_face = 2000;
/// Bytes for each leaf of a running solve. docs/deploy.md: 2.1 to 2.7 KB.
inline constexpr std::uint64_t bytes_a_leaf = 2400;

/// Returns the bytes that a solve of `scene` takes at least.
inline std::uint64_t least_memory(const StoredScene& scene) { return bytes_a_face * scene.facts.face_count; }

}  // namespace alvor
