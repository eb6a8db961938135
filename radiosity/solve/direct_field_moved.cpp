// The part of DirectField that takes moved objects.

#include "radiosity/solve/direct_field.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace alvor {

/// Requires: keep_shares() was called, and the light is one of owned_lights_.
const LightForm& DirectField::form_of(const LightSource& light) const {
  const auto owned = std::ranges::find(owned_lights_, light.number(), [](const auto& other) { return other->number(); });
  return forms_[static_cast<std::size_t>(owned - owned_lights_.begin())];
}

/// Returns the way from leaves to a light, if it comes by one: what of it lies farthest, and how large that is, for a leaf at a
/// place. Metres.
std::function<DirectField::FarEnd(Vec3, double)> DirectField::way_to(const LightSource& light) const {
  const auto to_metres = [&](Vec3 p) { return scene_.frame().to_metres(p); };
  const double far = 3 * forests_.mesh().extent();
  const std::optional<Light>& is = form_of(light).light;
  if (const auto extent = light.extent()) {
    const Vec3 middle = lerp(to_metres(extent->low), to_metres(extent->high), 0.5);
    const double radius = length(to_metres(extent->high) - middle);
    return [=](Vec3, double) { return FarEnd{middle, radius}; };
  }
  if (is && is->kind == LightKind::directional && light.aperture().empty()) {
    const Vec3 way = far * is->direction;
    const double spread = far * std::tan(is->angular_diameter / 2);
    return [=](Vec3 leaf, double radius) { return FarEnd{leaf - way, radius + spread}; };
  }
  if (light.aperture().empty()) return nullptr;
  BoundingBox box;
  for (const Vec3 corner : light.aperture()) box.add(to_metres(corner));
  const Vec3 middle = lerp(box.low, box.high, 0.5);
  const double half = length(box.high - middle);
  return [=](Vec3 leaf, double radius) {  // through the aperture, and on
    const double times = std::max(1.0, far / std::max(length(middle - leaf), 1e-9 * far));
    return FarEnd{leaf + times * (middle - leaf), radius + times * (half + radius)};
  };
}

/// Marks in `changed` the leaves to which what the light brings may have changed. Of light from all around those in sight of the
/// move, which `in_sight` tells, have other light.
void DirectField::mark_changed(const LightSource& light, const MovedRoots& moved, std::span<const NodeIndex> leaves,
                               const LeavesInSight& in_sight, std::span<std::uint8_t> changed) const {
  if (moved.has_any(form_of(light).roots)) {
    std::ranges::fill(changed, std::uint8_t{1});
    return;
  }
  const auto far_end = way_to(light);
  if (!far_end) {
    const auto& seeing = in_sight();
    for (std::size_t n = 0; n < leaves.size(); ++n) changed[n] |= seeing[n];
    return;
  }
  tbb::parallel_for(std::size_t{0}, leaves.size(), [&](std::size_t n) {
    if (changed[n]) return;
    const Vec3 leaf = forests_.leaf_centres()[leaves[n]];
    const PatchShape shape = forests_.leaves().shape(leaves[n]);
    const auto corners = corners_of(forests_.mesh(), shape);
    double radius = 0;
    for (int c = 0; c < shape.corner_count; ++c) radius = std::max(radius, length(corners[static_cast<std::size_t>(c)] - leaf));
    const FarEnd end = far_end(leaf, radius);
    changed[n] = moved.may_meet(leaf, radius, end.middle, end.radius);
  });
}

void DirectField::note_moved(const MovedRoots& moved, const RowsInSight& in_sight) {
  blockers_.reset();
  if (exact_faces_ || exact_exits_) blockers_ = std::make_unique<BlockerTree>(scene_);
  keep_shares_of_present_lights();
  const std::vector<NodeIndex> leaves = forests_.all_leaves();
  std::vector<std::uint8_t> seeing;
  const LeavesInSight leaves_in_sight = [&]() -> const std::vector<std::uint8_t>& {
    if (!seeing.empty()) return seeing;
    const std::vector<std::uint8_t> by_row = in_sight();
    seeing.resize(leaves.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, leaves.size()), [&](const tbb::blocked_range<std::size_t>& part) {
      RowFinder finder(forests_);
      for (std::size_t n = part.begin(); n < part.end(); ++n) seeing[n] = by_row[finder.row_of(leaves[n])];
    });
    return seeing;
  };
  std::vector<std::uint8_t> is_lost(leaves.size());
  if (light_tree_) {
    const bool has_moved = std::ranges::any_of(forms_, [&](const LightForm& form) { return moved.has_any(form.roots); });
    is_lost = has_moved ? std::vector<std::uint8_t>(leaves.size(), 1) : leaves_in_sight();
  }
  for (std::size_t n = 0; n < leaves.size(); ++n) {
    if (!moved.has(forests_.leaves().id(leaves[n]).root_face())) continue;
    is_lost[n] = 1;
    shares_.forget(leaves[n]);
  }
  for (const auto& light : owned_lights_) {
    if (light_tree_ && light->extent()) continue;
    auto changed = shares_.keeps(*light) ? std::vector<std::uint8_t>(leaves.size()) : is_lost;
    mark_changed(*light, moved, leaves, leaves_in_sight, changed);
    for (std::size_t n = 0; n < leaves.size(); ++n) {
      if (!changed[n]) continue;
      is_lost[n] = 1;
      shares_.forget(*light, leaves[n]);
    }
  }
  double lost = 0;
  for (std::size_t n = 0; n < leaves.size(); ++n) {
    if (!is_lost[n]) continue;
    is_known_[leaves[n]] = false;
    ray_level_[leaves[n]] = 0;
    lost += forests_.leaf_area(leaves[n]) / forests_.area();
  }
  waiting_power_ = std::max(waiting_power_, std::min(1.0, lost) * power_);
}

}  // namespace alvor
