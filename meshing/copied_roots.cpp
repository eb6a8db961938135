// The part of BaseMesh that appends the roots of objects that edits added: copies of its own roots, or of those of another mesh.

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

/// Appends the roots of those of `objects` that come after the objects of this mesh, and so were added.
void BaseMesh::append_objects(std::span<const SceneObject> objects, const AddedMeshes& added) {
  if (objects.size() <= objects_.size()) return;
  std::vector<std::vector<std::uint32_t>> roots_of(objects.size());
  for (std::uint32_t r = 0; r < roots_.size(); ++r)
    if (const auto object = object_of_face(objects, roots_[r].input.first)) roots_of[*object].push_back(r);
  std::uint32_t next_vertex = first_free_vertex();
  for (std::size_t n = objects_.size(); n < objects.size(); ++n) {
    const auto first = static_cast<std::uint32_t>(roots_.size());
    if (objects[n].from_scene.empty()) append_copy(objects, objects[n], roots_of, next_vertex);
    else append_mesh(*added.at(objects[n].from_scene), objects[n].first_face, next_vertex);
    for (std::uint32_t r = first; r < roots_.size(); ++r) roots_of[n].push_back(r);
  }
}

void BaseMesh::append_copy(std::span<const SceneObject> objects, const SceneObject& copy,
                           std::span<const std::vector<std::uint32_t>> roots_of, std::uint32_t& next_vertex) {
  CopiedObject copied = copied_object(objects, copy);
  std::vector<std::uint32_t> sources;
  for (const auto& [object, first] : copied.first_face)
    sources.insert(sources.end(), roots_of[object].begin(), roots_of[object].end());
  std::ranges::sort(sources);
  for (const std::uint32_t source : sources)
    copied.roots.emplace(source, static_cast<std::uint32_t>(roots_.size() + copied.roots.size()));
  for (const std::uint32_t source : sources) {
    append_root(*this, source);
    roots_.back() = copied.copy_of(roots_.back(), next_vertex);
    for (auto& other : neighbours_.back()) other = copied.copy_of(other);
  }
}

/// Appends all roots of a mesh, turned upright, as those of faces from `first_face` on.
void BaseMesh::append_mesh(const BaseMesh& added, std::uint32_t first_face, std::uint32_t& next_vertex) {
  const auto first_root = static_cast<std::uint32_t>(roots_.size());
  const std::uint32_t first_vertex = next_vertex;
  next_vertex += added.first_free_vertex();
  const Placement turn = turn_upright(added.up_, up_);
  for (std::uint32_t r = 0; r < added.roots_.size(); ++r) {
    append_root(added, r);
    RootPatch& root = roots_.back();
    for (int c = 0; c < root.corner_count; ++c) {
      root.corners[c] = turn.point(root.corners[c]);
      root.vertex[c] += first_vertex;
    }
    root.normal = turn.direction(root.normal);
    root.input.first += first_face;
    if (root.input.second != InputFaces::none) root.input.second += first_face;
    if (root.twin != RootPatch::no_twin) root.twin += first_root;
    for (auto& other : neighbours_.back())
      if (other) other->root += first_root;
  }
}

/// Appends a copy of a root of a mesh, which may be this one, with its neighbours and the values of its corners.
void BaseMesh::append_root(const BaseMesh& from, std::uint32_t root) {
  constexpr std::array<RgbF, 4> white{RgbF{1, 1, 1}, RgbF{1, 1, 1}, RgbF{1, 1, 1}, RgbF{1, 1, 1}};
  if (has_textures() || from.has_textures()) {
    texture_points_.resize(roots_.size());
    texture_points_.push_back(from.has_textures() ? std::array(from.texture_points_[root]) : std::array<TexturePoint, 4>{});
  }
  if (has_colours() || from.has_colours()) {
    corner_colours_.resize(roots_.size(), white);
    corner_colours_.push_back(from.has_colours() ? std::array(from.corner_colours_[root]) : white);
  }
  neighbours_.push_back(std::array(from.neighbours_[root]));
  roots_.push_back(RootPatch(from.roots_[root]));
}

/// Returns a number above those of all vertices of roots.
std::uint32_t BaseMesh::first_free_vertex() const {
  std::uint32_t next = 0;
  for (const RootPatch& root : roots_)
    for (int c = 0; c < root.corner_count; ++c) next = std::max(next, root.vertex[c] + 1);
  return next;
}

}  // namespace alvor
