#include "meshing/edit/copied_objects.h"

#include <algorithm>
#include <unordered_set>
#include <utility>
#include <variant>
#include <vector>

namespace alvor {

namespace {

constexpr std::size_t longest_name = 1000, least_room = 100'000, most_copies = 1000;

}  // namespace

void append_copy(Scene& scene, std::string name, std::uint32_t of) {
  const std::vector<std::uint32_t> sources = faces_with_hanging(scene.objects, of);
  std::unordered_map<std::uint32_t, std::uint32_t> copied;  // vertices
  const auto first_face = static_cast<std::uint32_t>(scene.faces.size());
  for (const std::uint32_t source : sources) {
    const Face face = scene.faces[source];
    std::vector<std::uint32_t> ring;
    for (std::uint32_t k = 0; k < face.corner_count; ++k) {
      const std::uint32_t vertex = scene.corners[face.first_corner + k];
      const auto [own, is_new] = copied.try_emplace(vertex, static_cast<std::uint32_t>(scene.vertices.size()));
      if (is_new) scene.vertices.push_back(Vec3(scene.vertices[vertex]));
      ring.push_back(own->second);
    }
    const auto points = scene.texture_points_of(face);
    const auto colours = scene.colours_of(face);
    scene.add_face(ring, face.material, std::vector(points.begin(), points.end()), std::vector(colours.begin(), colours.end()));
  }
  SceneObject copy{.name = std::move(name), .placement = scene.objects[of].placement, .first_face = first_face};
  copy.face_count = static_cast<std::uint32_t>(sources.size());
  copy.copy_of = of;
  scene.objects.push_back(std::move(copy));
}

void append_copies(Scene& scene, std::span<const SceneEdit> edits) {
  std::unordered_map<std::string, std::uint32_t> newest;  // object of a name, when the edit was made
  std::vector<std::uint32_t> taken_back;
  for (const SceneEdit& edit : edits) {
    const auto* copy = std::get_if<ObjectCopy>(&edit);
    if (!copy) continue;
    if (newest.empty())
      for (std::uint32_t n = 0; n < scene.objects.size(); ++n) newest.emplace(scene.objects[n].name, n);
    const auto number = static_cast<std::uint32_t>(scene.objects.size());
    append_copy(scene, copy->name, newest.at(copy->of));
    newest[copy->name] = number;
    if (copy->is_taken_back) taken_back.push_back(number);
  }
  if (taken_back.empty()) return;
  std::unordered_set<std::string> names;
  for (const SceneObject& object : scene.objects) names.insert(object.name);
  for (const std::uint32_t number : taken_back) {
    SceneObject& object = scene.objects[number];
    object.is_hidden = true;
    object.name += " (taken back " + std::to_string(number) + ")";
    while (!names.insert(object.name).second) object.name += "'";
  }
}

bool has_copies(std::span<const SceneEdit> edits) {
  return std::ranges::any_of(edits, [](const SceneEdit& edit) { return std::holds_alternative<ObjectCopy>(edit); });
}

CheckedCopies::CheckedCopies(Scene& scene) : scene_(scene) {
  for (std::uint32_t n = 0; n < scene.objects.size(); ++n) {
    const SceneObject& object = scene.objects[n];
    if (!is_taken_back(object)) names_.emplace(object.name, n);
    if (object.copy_of) ++copies_, copied_faces_ += object.face_count;
  }
  room_ = std::max(least_room, scene.faces.size() - copied_faces_);
}

std::optional<EditFault> CheckedCopies::make(const ObjectCopy& copy) {
  if (copy.name.empty() || copy.name.size() > longest_name) return EditFault{0, "copy.name", "must have 1 to 1000 bytes"};
  if (names_.contains(copy.name)) return EditFault{0, "copy.name", "there is an object '" + copy.name + "'"};
  const auto of = names_.find(copy.of);
  if (of == names_.end()) return EditFault{0, "copy.of", "'" + copy.of + "' is no object of the scene"};
  const std::size_t faces = faces_with_hanging(scene_.objects, of->second).size(), with = copied_faces_ + faces;
  if (faces == 0) return EditFault{0, "copy.of", "'" + copy.of + "' has no faces"};
  if (with > room_)
    return EditFault{0, "copy.of",
                     "copies, with those that were taken back, would have " + std::to_string(with) + " faces, at most " +
                         std::to_string(room_) + " are allowed"};
  if (copies_ == most_copies)
    return EditFault{0, "copy.name", "there are 1000 copies, with those that were taken back, as many as are kept"};
  copied_faces_ = with, ++copies_;
  names_.emplace(copy.name, static_cast<std::uint32_t>(scene_.objects.size()));
  append_copy(scene_, copy.name, of->second);
  return std::nullopt;
}

}  // namespace alvor
