// The part of BaseMesh that copies the roots of objects.

#include "meshing/base_mesh.h"
#include "meshing/face_object.h"

#include <algorithm>
#include <array>
#include <optional>
#include <unordered_map>
#include <vector>

namespace alvor {

namespace {

using Numbers = std::unordered_map<std::uint32_t, std::uint32_t>;

std::uint32_t number_in(const Numbers& numbers, std::uint32_t of, std::uint32_t otherwise) {
  const auto found = numbers.find(of);
  return found == numbers.end() ? otherwise : found->second;
}

/// A copy of an object: what numbers its parts have, by the numbers of the parts that they are copies of.
struct CopiedObject {
  std::span<const SceneObject> objects;
  Numbers first_face;  // by object of which faces are copied
  Numbers roots, vertices;

  std::uint32_t face(std::uint32_t of) const {
    const auto object = of == InputFaces::none ? std::nullopt : object_of_face(objects, of);
    const auto first = object ? first_face.find(static_cast<std::uint32_t>(*object)) : first_face.end();
    return first == first_face.end() ? InputFaces::none : first->second + (of - objects[*object].first_face);
  }

  /// Returns the copy of a root. Its vertices get numbers from `next_vertex` on.
  RootPatch copy_of(RootPatch root, std::uint32_t& next_vertex) {
    root.input = {face(root.input.first), face(root.input.second)};
    for (int c = 0; c < root.corner_count; ++c) {
      const auto [vertex, is_new] = vertices.try_emplace(root.vertex[c], next_vertex);
      next_vertex += is_new;
      root.vertex[c] = vertex->second;
    }
    root.twin = number_in(roots, root.twin, RootPatch::no_twin);
    if (root.twin == RootPatch::no_twin) root.is_behind = false;
    return root;
  }

  /// Returns the neighbour of a copied root; none where the other root is not copied.
  std::optional<Neighbour> copy_of(std::optional<Neighbour> neighbour) const {
    const auto there = neighbour ? roots.find(neighbour->root) : roots.end();
    if (there == roots.end()) return std::nullopt;
    neighbour->root = there->second;
    return neighbour;
  }
};

CopiedObject copied_object(std::span<const SceneObject> objects, const SceneObject& copy) {
  CopiedObject copied{.objects = objects, .first_face = {}, .roots = {}, .vertices = {}};
  std::uint32_t next = copy.first_face;
  for (const std::uint32_t source : objects_with_hanging(objects, *copy.copy_of)) {
    copied.first_face.emplace(source, next);
    next += objects[source].face_count;
  }
  return copied;
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
  for (std::size_t n = objects_.size(); n < objects.size(); ++n) {
    CopiedObject copied = copied_object(objects, objects[n]);
    std::vector<std::uint32_t> sources;
    for (const auto& [object, first] : copied.first_face)
      sources.insert(sources.end(), roots_of[object].begin(), roots_of[object].end());
    std::ranges::sort(sources);
    for (const std::uint32_t source : sources) {
      roots_of[n].push_back(static_cast<std::uint32_t>(roots_.size() + copied.roots.size()));
      copied.roots.emplace(source, roots_of[n].back());
    }
    for (const std::uint32_t source : sources) {
      roots_.push_back(copied.copy_of(roots_[source], next_vertex));
      auto& across = neighbours_.emplace_back();
      std::ranges::transform(neighbours_[source], across.begin(), [&](const auto& other) { return copied.copy_of(other); });
      if (has_textures()) texture_points_.push_back(std::array(texture_points_[source]));
      if (has_colours()) corner_colours_.push_back(std::array(corner_colours_[source]));
    }
  }
}

}  // namespace alvor
