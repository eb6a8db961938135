// The part of BaseMesh that copies the roots of objects.

#include "meshing/base_mesh.h"
#include "meshing/face_object.h"

#include <algorithm>
#include <array>
#include <unordered_map>
#include <vector>

namespace alvor {

namespace {

/// The numbers that belong to a copy, by those of what was copied.
struct CopyNumbers {
  std::unordered_map<std::uint32_t, std::uint32_t> first_face;  // by object of which faces are copied
  std::unordered_map<std::uint32_t, std::uint32_t> roots, vertices;
};

/// Returns the first face of the copy of each object that is copied, by object.
std::unordered_map<std::uint32_t, std::uint32_t> first_faces(std::span<const SceneObject> objects, const SceneObject& copy) {
  std::unordered_map<std::uint32_t, std::uint32_t> first;
  std::uint32_t next = copy.first_face;
  for (std::uint32_t n = *copy.copy_of; n < objects.size(); ++n) {
    if (n != *copy.copy_of && !(objects[n].parent && first.contains(*objects[n].parent))) continue;
    first[n] = next;
    next += objects[n].face_count;
  }
  return first;
}

std::uint32_t face_of_copy(const CopyNumbers& numbers, std::span<const SceneObject> objects, std::uint32_t face) {
  if (face == InputFaces::none) return face;
  const auto object = object_of_face(objects, face);
  const auto first = object ? numbers.first_face.find(static_cast<std::uint32_t>(*object)) : numbers.first_face.end();
  return first == numbers.first_face.end() ? InputFaces::none : first->second + (face - objects[*object].first_face);
}

}  // namespace

/// Appends the roots of those of `objects` that come after the objects of this mesh, and so are copies.
void BaseMesh::append_copies(std::span<const SceneObject> objects) {
  if (objects.size() <= objects_.size()) return;
  std::vector<std::vector<std::uint32_t>> roots_of(objects.size());
  std::uint32_t next_vertex = 0;
  for (std::uint32_t r = 0; r < roots_.size(); ++r) {
    for (int c = 0; c < roots_[r].corner_count; ++c) next_vertex = std::max(next_vertex, roots_[r].vertex[c] + 1);
    if (const auto object = object_of_face(objects, roots_[r].input.first)) roots_of[*object].push_back(r);
  }
  for (std::size_t copy = objects_.size(); copy < objects.size(); ++copy) {
    CopyNumbers numbers{.first_face = first_faces(objects, objects[copy]), .roots = {}, .vertices = {}};
    std::vector<std::uint32_t> sources;
    for (const auto& [object, first] : numbers.first_face)
      sources.insert(sources.end(), roots_of[object].begin(), roots_of[object].end());
    std::ranges::sort(sources);
    for (const std::uint32_t source : sources) {
      const auto number = static_cast<std::uint32_t>(roots_.size() + numbers.roots.size());
      numbers.roots.emplace(source, number);
      roots_of[copy].push_back(number);
    }
    for (const std::uint32_t source : sources) {
      RootPatch root = roots_[source];
      root.input = {face_of_copy(numbers, objects, root.input.first), face_of_copy(numbers, objects, root.input.second)};
      for (int c = 0; c < root.corner_count; ++c) {
        const auto [vertex, is_new] = numbers.vertices.try_emplace(root.vertex[c], next_vertex);
        next_vertex += is_new;
        root.vertex[c] = vertex->second;
      }
      const auto twin = numbers.roots.find(root.twin);
      root.is_behind = root.is_behind && twin != numbers.roots.end();
      root.twin = twin == numbers.roots.end() ? RootPatch::no_twin : twin->second;
      auto across = neighbours_[source];
      for (auto& other : across) {
        if (!other) continue;
        const auto there = numbers.roots.find(other->root);
        if (there == numbers.roots.end()) other.reset();
        else other->root = there->second;
      }
      roots_.push_back(root);
      neighbours_.push_back(across);
      if (has_textures()) texture_points_.push_back(std::array(texture_points_[source]));
      if (has_colours()) corner_colours_.push_back(std::array(corner_colours_[source]));
    }
  }
}

}  // namespace alvor
