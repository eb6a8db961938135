#pragma once
// Encodes leaf values as bytes: docs/frame-format.md.

#include "alvor/v1/solve_service.pb.h"
#include "meshing/scene.h"
#include "solution/solution_log.h"

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace alvor {

/// Limits of a frame. A message beyond them is refused before anything is allocated.
inline constexpr std::size_t most_frame_bytes = 256 * 1024;  ///< before compression
inline constexpr std::size_t most_leaves_per_frame = most_frame_bytes / 5;
inline constexpr std::size_t most_errors_per_frame = most_frame_bytes;

v1::Detail encode(Detail detail);
/// Returns the detail; exact if the message does not set it.
Detail decode(v1::Detail detail);

/// Returns a number of leaves whose encoding stays below most_frame_bytes, whatever their ids.
std::size_t leaves_per_frame(Detail detail);

/// Returns the encoded values. Requires: `values` ascend and are disjoint, at most
/// leaves_per_frame(detail). For the display detail, `coding` must hold each value exactly.
v1::LeafValues encode_leaves(std::span<const LeafValue> values, Detail detail, SharedExponent coding);
/// Sets `values` to the decoded leaves: ids ascend, are valid and disjoint; values are finite and not negative. Returns a fault
/// if the message is malformed; `values` is then unspecified.
std::optional<Fault> decode_leaves(const v1::LeafValues& message, std::vector<LeafValue>& values);

/// Returns the encoded errors. Requires: at least one, at most most_errors_per_frame.
v1::LeafErrors encode_errors(const ErrorPage& page);
/// Sets `page`; its first patch is valid. Returns a fault if the message is malformed; `page` is then unspecified.
std::optional<Fault> decode_errors(const v1::LeafErrors& message, ErrorPage& page);

}  // namespace alvor
