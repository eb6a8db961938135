#include "meshing/scene_object.h"

#include <cmath>

namespace alvor {

namespace {

bool is_finite(Vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

}  // namespace

std::vector<std::uint32_t> objects_with_hanging(std::span<const SceneObject> objects, std::uint32_t which) {
  std::vector<std::uint32_t> found{which};
  std::vector<bool> hangs(objects.size());
  hangs[which] = true;
  for (std::uint32_t n = which + 1; n < objects.size(); ++n) {
    hangs[n] = objects[n].parent && hangs[*objects[n].parent];
    if (hangs[n]) found.push_back(n);
  }
  return found;
}

std::vector<std::uint32_t> faces_with_hanging(std::span<const SceneObject> objects, std::uint32_t which) {
  std::vector<std::uint32_t> faces;
  for (const std::uint32_t n : objects_with_hanging(objects, which))
    for (std::uint32_t k = 0; k < objects[n].face_count; ++k) faces.push_back(objects[n].first_face + k);
  return faces;
}

std::optional<std::string> fault_in(std::span<const SceneObject> objects, std::size_t which, std::size_t scene_faces) {
  const SceneObject& object = objects[which];
  if (object.name.empty()) return "has no name";
  if (object.parent && *object.parent >= which)
    return "its parent " + std::to_string(*object.parent) + " does not come before it";
  for (const Placement& p : {object.placement, object.motion})
    if (!(is_finite(p.x) && is_finite(p.y) && is_finite(p.z) && is_finite(p.origin)))
      return "its transform has a number that is not finite";
  if (object.face_count > scene_faces || object.first_face > scene_faces - object.face_count)
    return "its faces end beyond the " + std::to_string(scene_faces) + " faces of the scene";
  if (which > 0 && object.first_face < objects[which - 1].first_face + objects[which - 1].face_count)
    return "its faces begin before those of the object before it end";
  if (object.copy_of && *object.copy_of >= which)
    return "it is a copy of object " + std::to_string(*object.copy_of) + ", which does not come before it";
  return std::nullopt;
}

}  // namespace alvor
