#include "radiosity/solve/moved_roots.h"

#include "meshing/face_object.h"

#include <algorithm>
#include <map>

namespace alvor {

namespace {

/// Share of the scene's extent by which boxes are larger than what is in them, so that touching objects touch.
constexpr double margin = 1e-5;
/// Boxes of more objects than this are joined to one.
constexpr std::size_t most_boxes = 32;

bool is_elsewhere(const RootPatch& a, const RootPatch& b) {
  return a.is_hidden != b.is_hidden || !std::equal(a.corners.begin(), a.corners.begin() + a.corner_count, b.corners.begin());
}

BoundingBox grown(BoundingBox box, double by) {
  box.low = box.low - Vec3{by, by, by}, box.high = box.high + Vec3{by, by, by};
  return box;
}

/// Returns the boxes of the roots that count, one for each object.
template <class Counts>
std::vector<BoundingBox> boxes_of(const BaseMesh& mesh, Counts&& counts) {
  std::map<std::size_t, BoundingBox> by_object;
  for (std::uint32_t r = 0; r < mesh.roots().size(); ++r) {
    const RootPatch& root = mesh.roots()[r];
    if (!counts(r) || root.is_hidden) continue;
    BoundingBox& box = by_object[object_of_face(mesh.objects(), root.input.first).value_or(mesh.objects().size())];
    box.add(box_of(root));
  }
  std::vector<BoundingBox> boxes;
  for (const auto& [object, box] : by_object) {
    const BoundingBox own = grown(box, margin * mesh.extent());
    if (boxes.size() < most_boxes) boxes.push_back(own);
    else boxes.back().add(own);
  }
  return boxes;
}

bool overlap(const BoundingBox& a, const BoundingBox& b) {
  return a.high.x >= b.low.x && a.high.y >= b.low.y && a.high.z >= b.low.z && a.low.x <= b.high.x && a.low.y <= b.high.y &&
         a.low.z <= b.high.z;
}

bool meets(const BoundingBox& box, Vec3 from, Vec3 to) { return share_before(box, from, to).has_value(); }

/// Returns whether a shaft between two spheres may meet the box: the parts of its axis meet a box that is larger by the largest
/// radius of the part.
bool shaft_meets(const BoundingBox& box, Vec3 from, double from_radius, Vec3 to, double to_radius) {
  if (!meets(grown(box, std::max(from_radius, to_radius)), from, to)) return false;
  constexpr int parts = 8;
  for (int n = 0; n < parts; ++n) {
    const double a = double(n) / parts, b = double(n + 1) / parts;
    const auto radius = [&](double t) { return from_radius + t * (to_radius - from_radius); };
    if (meets(grown(box, std::max(radius(a), radius(b))), lerp(from, to, a), lerp(from, to, b))) return true;
  }
  return false;
}

}  // namespace

BoundingBox box_of(const RootPatch& root) {
  BoundingBox box;
  for (int c = 0; c < root.corner_count; ++c) box.add(root.corners[static_cast<std::size_t>(c)]);
  return box;
}

BoundingBox box_of(const BaseMesh& mesh, const PatchShape& shape) {
  BoundingBox box;
  const auto corners = corners_of(mesh, shape);
  for (int c = 0; c < shape.corner_count; ++c) box.add(corners[static_cast<std::size_t>(c)]);
  return box;
}

// Slabs (Kay and Kajiya 1986).
std::optional<double> share_before(const BoundingBox& box, Vec3 from, Vec3 to) {
  double first = 0, last = 1;
  const auto cut = [&](double start, double way, double low, double high) {
    if (way == 0) return start >= low && start <= high;
    const double a = (low - start) / way, b = (high - start) / way;
    first = std::max(first, std::min(a, b)), last = std::min(last, std::max(a, b));
    return first <= last;
  };
  const Vec3 way = to - from;
  const bool is_met = cut(from.x, way.x, box.low.x, box.high.x) && cut(from.y, way.y, box.low.y, box.high.y) &&
                      cut(from.z, way.z, box.low.z, box.high.z);
  return is_met ? std::optional(first) : std::nullopt;
}

MovedRoots::MovedRoots(const BaseMesh& before, const BaseMesh& after) : moved_(after.roots().size()) {
  for (std::uint32_t r = 0; r < moved_.size(); ++r) moved_[r] = is_elsewhere(before.roots()[r], after.roots()[r]);
  const auto has_free_edge = [&](std::uint32_t root) {
    bool has = false;
    for (int e = 0; e < after.roots()[root].corner_count; ++e) has = has || !after.across(root, e);
    return has;
  };
  for (std::uint32_t r = 0; r < moved_.size(); ++r)
    show_backs_ = show_backs_ || (has(r) && after.roots()[r].twin == RootPatch::no_twin && has_free_edge(r));
  const auto is_moved = [this](std::uint32_t root) { return has(root); };
  old_boxes_ = boxes_of(before, is_moved);
  new_boxes_ = boxes_of(after, is_moved);
  for (const BoundingBox& box : new_boxes_) all_new_.add(box);
}

std::vector<BoundingBox> MovedRoots::boxes() const {
  std::vector<BoundingBox> boxes = old_boxes_;
  boxes.insert(boxes.end(), new_boxes_.begin(), new_boxes_.end());
  return boxes;
}

bool MovedRoots::touch(const BoundingBox& box) const {
  const auto touches = [&](const BoundingBox& other) { return overlap(box, other); };
  return std::ranges::any_of(old_boxes_, touches) || std::ranges::any_of(new_boxes_, touches);
}

bool MovedRoots::may_cover(double share, Vec3 from, double radius) const {
  double covered = 0;
  for (const auto* boxes : {&old_boxes_, &new_boxes_}) {
    for (const BoundingBox& box : *boxes) {
      const double around = length(box.high - box.low) / 2;
      const double distance = std::max(length(lerp(box.low, box.high, 0.5) - from) - radius, around);
      covered += around * around / (distance * distance);
    }
  }
  return covered > share;
}

bool MovedRoots::may_meet_now(Vec3 from, Vec3 to, double radius) const {
  const Vec3 low = lower(from, to) - Vec3{radius, radius, radius}, high = upper(from, to) + Vec3{radius, radius, radius};
  if (!overlap({low, high}, all_new_)) return false;  // most rays of a large scene
  return std::ranges::any_of(new_boxes_, [&](const BoundingBox& box) { return meets(grown(box, radius), from, to); });
}

bool MovedRoots::may_meet(Vec3 from, double from_radius, Vec3 to, double to_radius) const {
  const auto may = [&](const BoundingBox& box) { return shaft_meets(box, from, from_radius, to, to_radius); };
  return std::ranges::any_of(old_boxes_, may) || std::ranges::any_of(new_boxes_, may);
}

bool MovedRoots::are_in_front(Vec3 point, Vec3 normal, bool also_before) const {
  const auto is_in_front = [&](const BoundingBox& box) {
    const Vec3 farthest{normal.x > 0 ? box.high.x : box.low.x, normal.y > 0 ? box.high.y : box.low.y,
                        normal.z > 0 ? box.high.z : box.low.z};
    return dot(farthest - point, normal) > 0;
  };
  return std::ranges::any_of(new_boxes_, is_in_front) || (also_before && std::ranges::any_of(old_boxes_, is_in_front));
}

}  // namespace alvor
