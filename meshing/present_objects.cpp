#include "meshing/present_objects.h"

#include <algorithm>
#include <iterator>
#include <optional>

namespace alvor {

PresentObjects::PresentObjects(std::span<const SceneObject> objects) {
  std::vector<std::optional<std::uint32_t>> number(objects.size());
  std::uint32_t missing = 0;
  for (std::size_t n = 0; n < objects.size(); ++n) {
    const SceneObject& object = objects[n];
    if (object.is_hidden) {
      missing += object.face_count;
      if (object.face_count > 0) gaps_.push_back({object.first_face, object.first_face + object.face_count, missing});
      continue;
    }
    number[n] = static_cast<std::uint32_t>(objects_.size());
    SceneObject& here = objects_.emplace_back();
    here.name = object.name;
    if (object.parent) here.parent = number[*object.parent];
    here.placement = object.placement;
    here.first_face = object.first_face - missing, here.face_count = object.face_count;
  }
}

/// Returns the last gap that begins at a face or before it; null if there is none.
const PresentObjects::Gap* PresentObjects::gap_up_to(std::uint32_t face) const {
  const auto after = std::ranges::upper_bound(gaps_, face, {}, &Gap::first);
  return after == gaps_.begin() ? nullptr : &*std::prev(after);
}

bool PresentObjects::has(std::uint32_t face) const {
  const Gap* const gap = gap_up_to(face);
  return !gap || face >= gap->last;
}

std::uint32_t PresentObjects::number_of(std::uint32_t face) const {
  const Gap* const gap = gap_up_to(face);
  return gap ? face - gap->so_far : face;
}

InputFaces PresentObjects::numbers_of(InputFaces faces) const {
  InputFaces here{number_of(faces.first), InputFaces::none};
  if (faces.second != InputFaces::none && has(faces.second)) here.second = number_of(faces.second);
  return here;
}

std::vector<Light> present_lights(std::span<const Light> lights) {
  std::vector<Light> present;
  std::ranges::remove_copy_if(lights, std::back_inserter(present), &Light::is_hidden);
  return present;
}

}  // namespace alvor
