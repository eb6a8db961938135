// The part of BaseMesh that follows edits: roots of objects that were moved or hidden.

#include "meshing/base_mesh.h"
#include "meshing/bounding_box.h"
#include "meshing/face_object.h"
#include "meshing/present_objects.h"
#include "solution/patch_id.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

namespace alvor {

namespace {

/// Roots that are where they were submitted, or that move together. Each object that is moved or hidden is a group of its own
/// unless it moves as another one does.
class MovingGroups {
 public:
  static constexpr std::uint32_t at_rest = ~0u;

  explicit MovingGroups(std::span<const SceneObject> objects) : objects_(objects), group_(objects.size(), at_rest) {
    std::vector<std::uint32_t> first;
    for (std::uint32_t n = 0; n < objects.size(); ++n) {
      if (!objects[n].is_hidden && objects[n].motion == Placement{}) continue;
      const auto same = std::ranges::find_if(first, [&](std::uint32_t other) {
        return objects[other].motion == objects[n].motion && objects[other].is_hidden == objects[n].is_hidden;
      });
      group_[n] = same == first.end() ? n : *same;
      if (group_[n] == n && first.size() < most_compared) first.push_back(n);
    }
  }

  /// Returns the first object of the group that a face belongs to.
  std::uint32_t of_face(std::uint32_t face) const {
    const auto object = object_of_face(objects_, face);
    return object ? group_[*object] : at_rest;
  }

 private:
  static constexpr std::size_t most_compared = 100;  // so that the time stays linear
  std::span<const SceneObject> objects_;
  std::vector<std::uint32_t> group_;  // by object
};

void move(RootPatch& root, const Placement& motion) {
  for (int c = 0; c < root.corner_count; ++c) root.corners[c] = motion.point(root.corners[c]);
  root.normal = normalized(motion.direction(root.normal));
  constexpr double rounding = 1e-9;  // a turn does not change the area
  if (const double larger = dot(motion.x, motion.x); std::abs(larger - 1) > rounding) root.area *= larger;
}

/// Gives the vertices of roots numbers, from `next` on, that no root of another group has.
void separate_vertices(std::span<RootPatch> roots, std::span<const std::uint32_t> group, std::uint32_t next) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> numbers;  // by group and vertex
  for (std::size_t r = 0; r < roots.size(); ++r)
    for (int c = 0; c < roots[r].corner_count && group[r] != MovingGroups::at_rest; ++c) {
      std::uint32_t& vertex = roots[r].vertex[c];
      const auto [number, is_new] = numbers.try_emplace({group[r], vertex}, next);
      next += is_new;
      vertex = number->second;
    }
}

}  // namespace

BaseMesh BaseMesh::edited_as(const Scene& scene, const AddedMeshes& added) const {
  BaseMesh edited = *this;
  edited.append_objects(scene.objects, added);
  if (edited.roots_.size() > PatchId::most_roots) throw TooManyRoots(edited.roots_.size());
  edited.materials_ = scene.materials;
  edited.lights_ = scene.lights;
  edited.absorption_ = scene.absorption;
  edited.objects_ = scene.objects;
  for (RootPatch& root : edited.roots_) root.material = scene.faces[root.input.first].material;
  edited.separate_objects(true);
  if (!edited.is_within_frame()) edited.find_bounds();
  return edited;
}

BaseMesh BaseMesh::with_hidden_roots_of(const BaseMesh& other) const {
  BaseMesh all = *this;
  const auto first_material = static_cast<std::uint32_t>(all.materials_.size());
  all.materials_.insert(all.materials_.end(), other.materials_.begin(), other.materials_.end());
  for (auto r = static_cast<std::uint32_t>(roots_.size()); r < other.roots_.size(); ++r) {
    all.append_root(other, r);
    RootPatch& root = all.roots_.back();
    root.material += first_material;
    root.is_hidden = root.is_behind = true;
  }
  return all;
}

BaseMesh BaseMesh::with_roots(std::span<const std::uint32_t> order) const {
  const PresentObjects present(objects_);
  std::vector<std::uint32_t> number(roots_.size(), RootPatch::no_twin);
  for (std::uint32_t n = 0; n < order.size(); ++n) number[order[n]] = n;
  BaseMesh some = *this;
  some.objects_ = present.objects();
  some.lights_ = present_lights(lights_);
  some.roots_.clear(), some.neighbours_.clear(), some.texture_points_.clear(), some.corner_colours_.clear();
  for (const std::uint32_t r : order) {
    some.append_root(*this, r);
    RootPatch& root = some.roots_.back();
    root.input = present.numbers_of(root.input);
    if (root.twin != RootPatch::no_twin) root.twin = number[root.twin];
    if (root.twin == RootPatch::no_twin) root.is_behind = false;
    for (auto& other : some.neighbours_.back()) {
      if (other) other->root = number[other->root];
      if (other && other->root == RootPatch::no_twin) other.reset();
    }
  }
  some.find_bounds();
  return some;
}

/// Takes roots of objects that are hidden or have moved from those that do not move with them. Puts them where the motions say if
/// they are not there yet.
void BaseMesh::separate_objects(bool are_to_move) {
  if (std::ranges::none_of(objects_, [](const SceneObject& o) { return o.is_hidden || o.motion != Placement{}; })) return;
  const MovingGroups groups(objects_);
  std::vector<std::uint32_t> group;
  for (const RootPatch& root : roots_) group.push_back(groups.of_face(root.input.first));
  separate_vertices(roots_, group, first_free_vertex());
  for (std::uint32_t r = 0; r < roots_.size(); ++r) {
    RootPatch& root = roots_[r];
    for (int e = 0; e < root.corner_count; ++e)
      if (auto& other = neighbours_[r][e]; other && group[other->root] != group[r]) other.reset();
    if (root.twin != RootPatch::no_twin && group[root.twin] != group[r]) root.twin = RootPatch::no_twin, root.is_behind = false;
    if (group[r] == MovingGroups::at_rest) continue;
    if (are_to_move) move(root, objects_[group[r]].motion);
    root.is_hidden = objects_[group[r]].is_hidden;
    if (root.is_hidden) root.is_behind = true;
  }
}

/// Returns whether a root has a place: not if it is of an object that was added and is hidden. One that was taken back is, and
/// may lie anywhere.
bool BaseMesh::counts_for_bounds(const RootPatch& root) const {
  if (!root.is_hidden) return true;
  const auto object = object_of_face(objects_, root.input.first);
  return !object || !objects_[*object].is_added();
}

/// Returns whether all roots that have a place lie in the cube about the centre that is as long as the extent.
bool BaseMesh::is_within_frame() const {
  BoundingBox frame;
  frame.add(centre_ - Vec3{extent_ / 2, extent_ / 2, extent_ / 2});
  frame.add(centre_ + Vec3{extent_ / 2, extent_ / 2, extent_ / 2});
  return std::ranges::all_of(roots_, [&](const RootPatch& root) {
    return !counts_for_bounds(root) ||
           std::ranges::all_of(std::span(root.corners).first(static_cast<std::size_t>(root.corner_count)),
                               [&](const Vec3& corner) { return frame.holds(corner); });
  });
}

}  // namespace alvor
