#pragma once
// Leaf values as bytes: docs/frame-format.md.

#include "alvor/v1/solve_service.pb.h"
#include "meshing/scene.h"
#include "solution/solution_log.h"

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace alvor {

/// What a frame may hold; a message that says more is refused before anything is allocated.
inline constexpr std::size_t most_frame_bytes = 256 * 1024;  ///< before compression
inline constexpr std::size_t most_leaves_per_frame = most_frame_bytes / 5;

v1::Detail encode(Detail detail);
/// Exact where it is not said.
Detail decode(v1::Detail detail);

/// How many leaves, however their ids jump, stay below most_frame_bytes.
std::size_t leaves_per_frame(Detail detail);

/// Requires: `values` ascend and are disjoint, of root faces below 2^31, at most leaves_per_frame(detail); for the display detail
/// each value is one that `coding` can hold exactly.
v1::LeafValues encode_leaves(std::span<const LeafValue> values, Detail detail, SharedExponent coding);
/// A fault says what contradicts itself; `values` is then unspecified. Ids ascend, are valid and disjoint; values are finite, not
/// negative.
std::optional<Fault> decode_leaves(const v1::LeafValues& message, std::vector<LeafValue>& values);

}  // namespace alvor
