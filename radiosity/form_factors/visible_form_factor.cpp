#include "radiosity/form_factors/visible_form_factor.h"

#include "radiosity/form_factors/form_factor.h"
#include "radiosity/form_factors/gauss.h"
#include "radiosity/form_factors/shadow_cone.h"

#include <array>
#include <cassert>
#include <cmath>
#include <queue>

namespace alvor {

namespace {

// Share of the size of two polygons: a corner closer to a plane than that lies in it. Chosen; half and double give the same
// solutions (docs/design/constants.md).
constexpr double flat_slack = 1e-12;

double size_of(const ConvexPolygon& a, const ConvexPolygon& b) {
  double size = 0;
  for (const ConvexPolygon* polygon : {&a, &b})
    for (const Vec3& corner : polygon->corners()) size = std::max(size, length(corner - a.corners()[0]));
  return size;
}

/// Appends the planes of the convex hull's sides that hold an edge of `edges` and a corner of `corners`, with the hull above
/// them.
void add_sides(const ConvexPolygon& edges, const ConvexPolygon& corners, double slack, std::vector<Plane>& sides) {
  const auto ring = edges.corners();
  for (std::size_t c = 0; c < ring.size(); ++c) {
    const Vec3 a = ring[c], along = ring[(c + 1) % ring.size()] - a;
    for (const Vec3& corner : corners.corners()) {
      const Vec3 across = cross(along, corner - a);
      const double scale = length(across);
      if (scale <= slack * length(along)) continue;
      Plane side{across / scale, dot(across / scale, a)};
      if (lies_below(edges.corners(), side, slack) && lies_below(corners.corners(), side, slack))
        side = {-side.normal, -side.offset};
      if (lies_above(edges.corners(), side, slack) && lies_above(corners.corners(), side, slack)) sides.push_back(side);
    }
  }
}

/// Returns whether both polygons lie on one side of the blocker's plane.
bool does_not_part(const ConvexPolygon& blocker, const ConvexPolygon& from, const ConvexPolygon& to) {
  const Vec3 normal = area_vector(blocker.corners());
  const Plane above{normal, dot(normal, blocker.corners()[0])}, below{-normal, -above.offset};
  return (lies_above(from.corners(), above, 0) && lies_above(to.corners(), above, 0)) ||
         (lies_above(from.corners(), below, 0) && lies_above(to.corners(), below, 0));
}

/// A triangle of the surface that is integrated over.
struct Cell {
  std::array<Vec3, 3> corner;
  double value = 0, error = 0;
  friend bool operator<(const Cell& a, const Cell& b) { return a.error < b.error; }
};

/// Returns `from`, cut along the lines from which a corner of a blocker is seen on an edge of `to`, or a corner of `to` on an
/// edge of a blocker. Within a cell the visible part changes smoothly, and a thin leak of light has cells of its own. Events
/// between edges of several blockers are left out.
std::vector<ConvexPolygon> cut_at_events(const ConvexPolygon& from, const ConvexPolygon& to,
                                         std::span<const ConvexPolygon> blockers) {
  constexpr std::size_t most_cells =
      400;  // cells after which no more cuts are made. Chosen; half and double give the same solutions (docs/design/constants.md)
  std::vector<ConvexPolygon> cells{from}, next;
  const double slack = 1e-9 * size_of(from, from);
  const auto cut_all = [&](const ConvexPolygon& edges, const ConvexPolygon& corners) {
    const auto ring = edges.corners();
    for (std::size_t c = 0; c < ring.size(); ++c)
      for (const Vec3& corner : corners.corners()) {
        const Vec3 across = cross(ring[(c + 1) % ring.size()] - ring[c], corner - ring[c]);
        if (cells.size() > most_cells || dot(across, across) == 0) continue;
        const Vec3 normal = normalized(across);
        const Plane plane{normal, dot(normal, corner)}, other{-plane.normal, -plane.offset};
        next.clear();
        for (const ConvexPolygon& cell : cells) {
          if (lies_above(cell.corners(), plane, slack) || lies_below(cell.corners(), plane, slack)) {
            next.push_back(cell);
            continue;
          }
          next.push_back(part_above(cell, plane));
          next.push_back(part_above(cell, other));
        }
        cells.swap(next);
      }
  };
  for (const ConvexPolygon& blocker : blockers) {
    cut_all(blocker, to);
    cut_all(to, blocker);
  }
  return cells;
}

/// The integral of point_to_visible() over a polygon, adaptive: the cell with the largest error is split first.
class SurfaceIntegral {
 public:
  SurfaceIntegral(const ConvexPolygon& from, const ConvexPolygon& to, std::span<const ConvexPolygon> blockers)
      : normal_(plane_of(from.corners()).normal),
        to_(to),
        blockers_(blockers),
        negligible_(1e-15 * length(area_vector(from.corners()))) {
    for (const ConvexPolygon& part : cut_at_events(from, to, blockers)) {
      const auto corners = part.corners();
      for (std::size_t c = 2; c < corners.size(); ++c) {
        Cell cell{{corners[0], corners[c - 1], corners[c]}};
        cell.value = value_of(cell);
        split(cell);
      }
    }
  }

  void refine(double accuracy, std::uint64_t most_points) {
    while (error_ > accuracy * value_ && error_ > negligible_ && points_ + 28 <= most_points) refine_worst_ones(most_points);
  }

  double value() const { return value_; }  ///< form factor times the area of `from`
  double error() const { return error_; }
  std::uint64_t points() const { return points_; }

 private:
  double value_of(const Cell& cell) {
    const auto [p, q, r] = cell.corner;
    double sum = 0;
    for (const auto [a, b, weight] : radon_7)
      sum += weight * point_to_visible(p + a * (q - p) + b * (r - p), normal_, to_, blockers_);
    points_ += radon_7.size();
    return 0.5 * length(cross(q - p, r - p)) * sum;
  }

  /// Refines the cell with the largest error and those whose errors differ from it by rounding only. Else rounding would decide
  /// which of some symmetric cells are refined before the error is small enough, and the result would depend on the unit of
  /// length.
  void refine_worst_ones(std::uint64_t most_points) {
    constexpr double alike = 1 - 1e-6;
    const double worst = cells_.top().error;
    do refine_worst();
    while (cells_.top().error >= alike * worst && points_ + 28 <= most_points);
  }

  void refine_worst() {
    const Cell worst = cells_.top();
    cells_.pop();
    value_ -= worst.value;
    error_ -= worst.error;
    split(worst);
  }

  // The four children share three times their difference from the parent as their error. That is pessimistic for smooth values;
  // at shadow lines the difference alone was measured to be too small by half.
  void split(const Cell& parent) {
    const auto [a, b, c] = parent.corner;
    const Vec3 ab = lerp(a, b, 0.5), bc = lerp(b, c, 0.5), ca = lerp(c, a, 0.5);
    std::array<Cell, 4> children{Cell{{a, ab, ca}}, Cell{{ab, b, bc}}, Cell{{ca, bc, c}}, Cell{{bc, ca, ab}}};
    double sum = 0;
    for (Cell& child : children) sum += child.value = value_of(child);
    for (Cell& child : children) {
      child.error = 0.75 * std::abs(sum - parent.value);
      value_ += child.value;
      error_ += child.error;
      cells_.push(child);
    }
  }

  Vec3 normal_;
  const ConvexPolygon& to_;
  std::span<const ConvexPolygon> blockers_;
  double negligible_;  // error below which the integral is not refined
  std::priority_queue<Cell> cells_;
  double value_ = 0, error_ = 0;
  std::uint64_t points_ = 0;
};

}  // namespace

Obstruction::Obstruction(const ConvexPolygon& from, const ConvexPolygon& to, std::span<const ConvexPolygon* const> blockers) {
  assert(!from.is_empty() && !to.is_empty());
  if (blockers.empty()) return;
  const double slack = flat_slack * size_of(from, to);
  std::vector<Plane> sides{plane_of(from.corners()), plane_of(to.corners())};
  for (const ConvexPolygon* blocker : blockers) {
    if (lies_below(blocker->corners(), sides[0], slack) || lies_below(blocker->corners(), sides[1], slack)) continue;
    if (does_not_part(*blocker, from, to)) continue;
    if (sides.size() == 2) {
      add_sides(from, to, slack, sides);
      add_sides(to, from, slack, sides);
    }
    const ConvexPolygon inside = part_inside(*blocker, sides, slack);
    if (inside.is_empty()) continue;
    parts_.push_back(inside);
    // Both polygons and the blocker are convex, so if no corner sees a corner, no point sees a point.
    is_total_ = is_total_ || std::ranges::all_of(from.corners(), [&](const Vec3& corner) {
                  return ShadowCone(corner, inside.corners()).covers(to);
                });
  }
}

double point_to_visible(Vec3 point, Vec3 normal, const ConvexPolygon& to, std::span<const ConvexPolygon> blockers) {
  thread_local std::vector<ConvexPolygon> lit, next;
  lit.assign(1, to);
  for (const ConvexPolygon& blocker : blockers) {
    const ShadowCone shadow(point, blocker.corners());
    next.clear();
    for (const ConvexPolygon& piece : lit) shadow.cut_from(piece, next);
    lit.swap(next);
    if (lit.empty()) return 0;
  }
  double sum = 0;
  for (const ConvexPolygon& piece : lit) sum += point_to_polygon_above(point, normal, piece.corners());
  return std::clamp(sum, 0.0, 1.0);
}

VisibleFormFactor visible_form_factor(const ConvexPolygon& from, const ConvexPolygon& to,
                                      std::span<const ConvexPolygon* const> blockers, double accuracy,
                                      std::uint64_t most_points) {
  ConvexPolygon a = from, b = to;
  cut_to_fronts(a, b);
  if (a.is_empty() || b.is_empty()) return {};
  const Obstruction between(a, b, blockers);
  if (between.is_clear()) return {polygon_form_factor(from, to, 1e-9), 0};
  if (between.is_total()) return {};
  VisibleFormFactor seen = obstructed_form_factor(a, b, between.parts(), accuracy, most_points);
  const double share = length(area_vector(a.corners())) / length(area_vector(from.corners()));
  seen.value *= share, seen.error_bound *= share;
  return seen;
}

VisibleFormFactor obstructed_form_factor(const ConvexPolygon& from, const ConvexPolygon& to,
                                         std::span<const ConvexPolygon> blockers, double accuracy, std::uint64_t most_points) {
  assert(!from.is_empty() && !to.is_empty() && !blockers.empty());
  const double area = length(area_vector(from.corners()));
  SurfaceIntegral integral(from, to, blockers);
  integral.refine(accuracy, most_points);
  return {{std::clamp(integral.value() / area, 0.0, 1.0), integral.error() / area + 1e-14}, integral.points()};
}

}  // namespace alvor
