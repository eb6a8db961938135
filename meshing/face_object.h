#pragma once

#include "meshing/scene_object.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <optional>
#include <span>

namespace alvor {

/// Returns the number of the object that a face of the scene belongs to; nothing if it belongs to none. Requires: no object has a
/// fault (fault_in()), so that their faces come in their order.
inline std::optional<std::size_t> object_of_face(std::span<const SceneObject> objects, std::uint32_t face) {
  const auto after = std::ranges::upper_bound(objects, face, {}, &SceneObject::first_face);
  if (after == objects.begin()) return std::nullopt;
  const SceneObject& last = *std::prev(after);
  if (face - last.first_face >= last.face_count) return std::nullopt;
  return static_cast<std::size_t>(after - objects.begin()) - 1;
}

}  // namespace alvor
