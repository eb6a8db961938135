#include "radiosity/direct/blocker_tree.h"

#include "meshing/disjoint_sets.h"
#include "radiosity/form_factors/blockers.h"
#include "radiosity/rays/ray_source.h"

#include <algorithm>
#include <utility>

namespace alvor {

namespace {

// Most blockers of a node that is not split. Chosen.
constexpr std::uint32_t blockers_per_node = 4;
// Most roots of a scene whose faces are joined: in larger scenes joining takes seconds. Chosen.
constexpr std::size_t most_joined_roots = 200'000;

std::array<double, 3> coordinates(const Vec3& v) { return {v.x, v.y, v.z}; }

void include(BoxCorners& box, const BoxCorners& other) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.low[axis] = std::min(box.low[axis], other.low[axis]);
    box.high[axis] = std::max(box.high[axis], other.high[axis]);
  }
}

/// Returns for each root whether it belongs to a closed surface and which: `open`, or a number below the number of closed
/// surfaces.
constexpr std::uint32_t open = ~0u;
std::vector<std::uint32_t> closed_surfaces(const BaseMesh& mesh) {
  const auto count = static_cast<std::uint32_t>(mesh.roots().size());
  DisjointSets surfaces(count);
  std::vector<bool> is_open(count);
  for (std::uint32_t r = 0; r < count; ++r) {
    const RootPatch& root = mesh.roots()[r];
    is_open[r] = root.twin != RootPatch::no_twin;
    for (int e = 0; e < root.corner_count; ++e) {
      const auto across = mesh.across(r, e);
      if (across) surfaces.join(r, across->root);
      else is_open[r] = true;
    }
  }
  for (std::uint32_t r = 0; r < count; ++r)
    if (is_open[r]) is_open[surfaces.find(r)] = true;
  std::vector<std::uint32_t> number(count, open), closed(count, open);
  std::uint32_t found = 0;
  for (std::uint32_t r = 0; r < count; ++r) {
    const std::uint32_t surface = surfaces.find(r);
    if (is_open[surface]) continue;
    if (number[surface] == open) number[surface] = found++;
    closed[r] = number[surface];
  }
  return closed;
}

/// Returns the roots for which `counts` holds, joined unless they are too many.
std::vector<JoinedFace> faces_of(const BaseMesh& mesh, const std::function<bool(std::uint32_t)>& counts) {
  if (mesh.roots().size() <= most_joined_roots) return joined_faces(mesh, counts);
  std::vector<JoinedFace> faces;
  for (std::uint32_t r = 0; r < mesh.roots().size(); ++r) {
    const RootPatch& root = mesh.roots()[r];
    if (!root.is_back && counts(r)) faces.push_back({{root.corners.begin(), root.corners.begin() + root.corner_count}, r});
  }
  return faces;
}

}  // namespace

BoxCorners BoxCorners::of(std::span<const Vec3> points) {
  BoxCorners box{coordinates(points[0]), coordinates(points[0])};
  for (const Vec3& point : points.subspan(1)) include(box, {coordinates(point), coordinates(point)});
  return box;
}

bool BoxCorners::touches(const BoxCorners& other) const {
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (low[axis] > other.high[axis] || other.low[axis] > high[axis]) return false;
  return true;
}

// In each pair of coordinates the hull of two rectangles has an edge between two corners of the same kind, such as the lower
// right ones, if one rectangle reaches farther in one coordinate and the other one in the other.
Shaft::Shaft(const BoxCorners& from, const BoxCorners& to) : box_(from) {
  include(box_, to);
  constexpr std::array<std::array<std::size_t, 2>, 3> pairs{{{0, 1}, {1, 2}, {2, 0}}};
  for (const auto [x, y] : pairs)
    for (const double sign_x : {-1.0, 1.0})
      for (const double sign_y : {-1.0, 1.0}) {
        const auto &corner_x = sign_x > 0 ? from.high : from.low, &corner_y = sign_y > 0 ? from.high : from.low;
        const auto &other_x = sign_x > 0 ? to.high : to.low, &other_y = sign_y > 0 ? to.high : to.low;
        const double farther_x = sign_x * (other_x[x] - corner_x[x]), farther_y = sign_y * (other_y[y] - corner_y[y]);
        if (!(farther_x * farther_y < 0)) continue;
        const double a = sign_x * std::abs(farther_y), b = sign_y * std::abs(farther_x);
        sides_[count_++] = {x, y, a, b, a * corner_x[x] + b * corner_y[y]};
      }
}

bool Shaft::may_touch(const BoxCorners& box) const {
  if (!box_.touches(box)) return false;
  for (std::size_t s = 0; s < count_; ++s) {
    const Side& side = sides_[s];
    const double x = (side.a > 0 ? box.low : box.high)[side.x], y = (side.b > 0 ? box.low : box.high)[side.y];
    if (side.a * x + side.b * y > side.offset) return false;
  }
  return true;
}

BlockerTree::BlockerTree(const LocalScene& scene) {
  const auto solid_of_root = closed_surfaces(scene.mesh());
  add(scene, false, solid_of_root);
  add(scene, true, solid_of_root);
  if (blockers_.empty()) return;
  nodes_.emplace_back();
  build(0, 0, static_cast<std::uint32_t>(blockers_.size()));
}

/// Adds either all panes and faces with holes, or all others.
void BlockerTree::add(const LocalScene& scene, bool panes, std::span<const std::uint32_t> solid_of_root) {
  const BaseMesh& mesh = scene.mesh();
  const auto counts = [&](std::uint32_t r) { return !mesh.roots()[r].is_behind && mesh.material_of(r).is_pane() == panes; };
  for (const JoinedFace& face : faces_of(mesh, counts)) {
    Blocker blocker;
    blocker.first = static_cast<std::uint32_t>(corners_.size());
    blocker.count = static_cast<std::uint32_t>(face.corners.size());
    blocker.solid = solid_of_root[face.root];
    blocker.lets_light_through = panes;
    for (const Vec3& corner : face.corners) corners_.push_back(scene.frame().to_local(corner));
    blocker.plane = plane_of(corners_of(blocker));
    blocker.box = BoxCorners::of(corners_of(blocker));
    blockers_.push_back(blocker);
    if (blocker.solid == no_solid) continue;
    if (blocker.solid >= solids_.size()) solids_.resize(blocker.solid + 1, blocker.box);
    include(solids_[blocker.solid], blocker.box);
  }
}

// Each node is split in half by the middles of its blockers along the longest side of its box.
void BlockerTree::build(std::uint32_t node, std::uint32_t first, std::uint32_t last) {
  BoxCorners box = blockers_[first].box;
  for (std::uint32_t b = first; b < last; ++b) include(box, blockers_[b].box);
  nodes_[node] = {box, first, last - first};
  if (last - first <= blockers_per_node) return;
  std::size_t longest = 0;
  for (std::size_t axis = 1; axis < 3; ++axis)
    if (box.high[axis] - box.low[axis] > box.high[longest] - box.low[longest]) longest = axis;
  const auto twice_the_middle = [longest](const Blocker& blocker) {
    return blocker.box.low[longest] + blocker.box.high[longest];
  };
  const std::uint32_t half = first + (last - first) / 2;
  std::nth_element(blockers_.begin() + first, blockers_.begin() + half, blockers_.begin() + last,
                   [&](const Blocker& a, const Blocker& b) { return twice_the_middle(a) < twice_the_middle(b); });
  const auto children = static_cast<std::uint32_t>(nodes_.size());
  nodes_.resize(nodes_.size() + 2);
  nodes_[node].first = children, nodes_[node].count = 0;
  build(children, first, half);
  build(children + 1, half, last);
}

/// A patch and a light, of which blockers are asked whether they may stand between.
class BlockerTree::Between {
 public:
  Between(const Flat& patch, const Flat& light)
      : patch_(patch),
        light_(light),
        ground_{patch.normal, dot(patch.normal, patch.corners[0])},
        lamp_{light.normal, dot(light.normal, light.corners[0])},
        light_box_(BoxCorners::of(light.corners)),
        shaft_(BoxCorners::of(patch.corners), light_box_) {}

  bool may_touch(const BoxCorners& box) const { return shaft_.may_touch(box); }

  bool is_met_by(const Blocker& blocker, std::span<const Vec3> corners, std::span<const BoxCorners> solids) const {
    constexpr double slack = ray_offset;
    if (!shaft_.may_touch(blocker.box)) return false;
    if (lies_below(corners, ground_, slack) || lies_below(corners, lamp_, slack)) return false;
    const bool is_seen_from_front = lies_above(patch_.corners, blocker.plane, slack);
    if (is_seen_from_front && lies_above(light_.corners, blocker.plane, slack)) return false;
    if (lies_below(patch_.corners, blocker.plane, slack) && lies_below(light_.corners, blocker.plane, slack)) return false;
    return !is_seen_from_front || blocker.solid == no_solid || solids[blocker.solid].touches(light_box_);
  }

 private:
  const Flat& patch_;
  const Flat& light_;
  Plane ground_, lamp_;
  BoxCorners light_box_;
  Shaft shaft_;
};

/// A patch and a rectangle through which light comes from infinitely far away.
class BlockerTree::Through {
 public:
  Through(const Flat& patch, const Flat& rectangle)
      : patch_(patch),
        rectangle_{rectangle.normal, dot(rectangle.normal, rectangle.corners[0])},
        ground_{patch.normal, dot(patch.normal, patch.corners[0])},
        box_(BoxCorners::of(rectangle.corners)),
        between_(patch, rectangle) {
    is_before_ = lies_above(patch.corners, rectangle_, -slack);
    if (is_before_) set_sides(rectangle.corners);
  }

  /// Returns whether all of the patch lies before the rectangle. If not, nothing else may be asked.
  bool is_before() const { return is_before_; }
  bool may_touch(const BoxCorners& box) const {
    if (between_.may_touch(box)) return true;
    return !(lowest(rectangle_, box) > slack) && is_in_cones([&](const Plane& side) { return highest(side, box) > slack; });
  }
  bool is_met_by(const Blocker& blocker, std::span<const Vec3> corners, std::span<const BoxCorners> solids) const {
    if (between_.is_met_by(blocker, corners, solids)) return true;
    if (lies_below(corners, ground_, slack) || lies_above(corners, rectangle_, -slack)) return false;
    if (!is_in_cones([&](const Plane& side) { return !lies_below(corners, side, slack); })) return false;
    const bool is_seen_from_front = lies_above(patch_.corners, blocker.plane, slack);
    return !is_seen_from_front || blocker.solid == no_solid || solids[blocker.solid].touches(box_);
  }

 private:
  static constexpr double slack = ray_offset;
  /// Sets the planes through an edge of the rectangle and a corner of the patch. They bound the places behind the rectangle from
  /// which light reaches the patch, because corners have the outermost planes of all points of the patch: the height of a place
  /// above such a plane is linear in the point of the patch.
  void set_sides(std::span<const Vec3> corners) {
    Vec3 middle;
    for (const Vec3& corner : corners) middle += corner / static_cast<double>(corners.size());
    for (std::size_t e = 0; e < corners.size(); ++e)
      for (const Vec3& corner : patch_.corners) {
        const Vec3 here = corners[e], next = corners[(e + 1) % corners.size()];
        // A corner in the rectangle's plane has no cone: one a little before it stands for it.
        const Vec3 from = corner + std::max(0.0, slack - rectangle_.height(corner)) * rectangle_.normal;
        if (length(cross(here - from, next - from)) == 0) {
          sides_.push_back({{}, -1});  // an edge without length bounds nothing
          continue;
        }
        const Vec3 normal = normalized(cross(here - from, next - from));
        const Plane side{normal, dot(normal, from)};
        sides_.push_back(side.height(middle) > 0 ? side : Plane{-side.normal, -side.offset});
      }
  }
  /// Returns whether for each edge there is a point of the patch for which `reaches` holds.
  template <class Reaches>
  bool is_in_cones(Reaches&& reaches) const {
    const std::size_t of_edge = patch_.corners.size();
    for (std::size_t first = 0; first < sides_.size(); first += of_edge)
      if (std::none_of(sides_.begin() + static_cast<std::ptrdiff_t>(first),
                       sides_.begin() + static_cast<std::ptrdiff_t>(first + of_edge), reaches))
        return false;
    return true;
  }
  static double highest(const Plane& plane, const BoxCorners& box) {
    const auto n = coordinates(plane.normal);
    double height = -plane.offset;
    for (std::size_t axis = 0; axis < 3; ++axis) height += std::max(n[axis] * box.low[axis], n[axis] * box.high[axis]);
    return height;
  }
  static double lowest(const Plane& plane, const BoxCorners& box) { return -highest({-plane.normal, -plane.offset}, box); }

  const Flat& patch_;
  Plane rectangle_, ground_;
  BoxCorners box_;
  Between between_;
  bool is_before_ = false;
  std::vector<Plane> sides_;  // by edge, and within by corner of the patch
};

void BlockerTree::find_between(const Flat& patch, const Flat& light, std::size_t most, Found& found) const {
  found.polygons.clear();
  found.is_complete = true;
  if (!nodes_.empty()) find(Between(patch, light), most, found);
}

void BlockerTree::find_through(const Flat& patch, const Flat& rectangle, std::size_t most, Found& found) const {
  found.polygons.clear();
  const Through question(patch, rectangle);
  found.is_complete = question.is_before();
  if (found.is_complete && !nodes_.empty()) find(question, most, found);
}

template <class Question>
void BlockerTree::find(const Question& question, std::size_t most, Found& found) const {
  std::array<std::uint32_t, 64> waiting{0};  // nodes; each half of a node has half of its blockers, so 32 levels are enough
  for (std::size_t count = 1; count > 0;) {
    const Node& node = nodes_[waiting[--count]];
    if (!question.may_touch(node.box)) continue;
    if (node.count == 0) {
      waiting[count++] = node.first;
      waiting[count++] = node.first + 1;
    }
    for (std::uint32_t b = node.first; b < node.first + node.count; ++b) {
      const Blocker& blocker = blockers_[b];
      if (!question.is_met_by(blocker, corners_of(blocker), solids_)) continue;
      found.is_complete = !blocker.lets_light_through && found.polygons.size() < most;
      if (!found.is_complete) return;
      found.polygons.push_back(corners_of(blocker));
    }
  }
}

}  // namespace alvor
