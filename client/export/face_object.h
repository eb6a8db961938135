#pragma once

#include "meshing/scene_object.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace alvor {

/// Returns the number of the object that a face of the scene belongs to; nothing if it belongs to none.
inline std::optional<std::size_t> object_of_face(std::span<const SceneObject> objects, std::uint32_t face) {
  const auto found = std::ranges::find_if(objects, [&](const SceneObject& object) {
    return face >= object.first_face && face - object.first_face < object.face_count;
  });
  if (found == objects.end()) return std::nullopt;
  return static_cast<std::size_t>(found - objects.begin());
}

}  // namespace alvor
