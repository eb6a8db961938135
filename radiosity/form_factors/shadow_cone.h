#pragma once
// The shadow of a polygon that is seen from a point.

#include "radiosity/form_factors/convex_polygon.h"

#include <algorithm>
#include <array>
#include <span>
#include <vector>

namespace alvor {

/// The cone of the rays from a point through a convex polygon, its blocker. It goes on beyond the blocker without end; in front
/// of the blocker it counts, too.
class ShadowCone {
 public:
  /// A point in the blocker's plane has no cone. Requires: at most ConvexPolygon::capacity corners.
  ShadowCone(Vec3 point, std::span<const Vec3> blocker) {
    const double height = dot(area_vector(blocker), blocker[0] - point);
    if (height == 0) return;
    for (std::size_t c = 0; c < blocker.size(); ++c) {
      const Vec3 here = blocker[c] - point, next = blocker[(c + 1) % blocker.size()] - point, across = cross(here, next);
      if (dot(across, across) <= no_angle * dot(here, here) * dot(next, next))
        continue;  // two corners that rounding put in one place
      const Vec3 inward = height > 0 ? across : -across;
      sides_[count_++] = {inward, dot(inward, point)};
    }
  }

  /// Returns whether all of `piece` is inside.
  bool covers(const ConvexPolygon& piece) const {
    return count_ > 0 && std::all_of(sides_.begin(), sides_.begin() + count_,
                                     [&](const Plane& side) { return lies_above(piece.corners(), side, 0); });
  }

  /// Returns the part of `piece` that lies inside.
  ConvexPolygon part_inside(const ConvexPolygon& piece) const {
    if (count_ == 0 || misses(piece)) return {};
    return alvor::part_inside(piece, std::span(sides_).first(static_cast<std::size_t>(count_)), 0);
  }

  /// Appends to `lit` the parts of `piece` that lie outside.
  void cut_from(const ConvexPolygon& piece, std::vector<ConvexPolygon>& lit) const {
    if (count_ == 0 || misses(piece)) {
      lit.push_back(piece);
      return;
    }
    ConvexPolygon rest = piece;
    for (int s = 0; s < count_ && !rest.is_empty(); ++s) {
      lit.emplace_back();
      move_part_below(rest, sides_[s], lit.back());
      if (lit.back().is_empty()) lit.pop_back();
    }
  }

 private:
  // Squared sine of the angle between two directions that count as one.
  static constexpr double no_angle = 1e-24;

  bool misses(const ConvexPolygon& piece) const {
    return std::any_of(sides_.begin(), sides_.begin() + count_,
                       [&](const Plane& side) { return lies_below(piece.corners(), side, 0); });
  }

  std::array<Plane, ConvexPolygon::capacity> sides_;  // the cone lies above all of these planes
  int count_ = 0;
};

}  // namespace alvor
