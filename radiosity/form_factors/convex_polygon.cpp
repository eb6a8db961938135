#include "radiosity/form_factors/convex_polygon.h"

#include <array>

namespace alvor {

Vec3 area_vector(std::span<const Vec3> polygon) {
  Vec3 sum;
  for (std::size_t c = 2; c < polygon.size(); ++c) sum += cross(polygon[c - 1] - polygon[0], polygon[c] - polygon[0]);
  return sum * 0.5;
}

Plane plane_of(std::span<const Vec3> polygon) {
  const Vec3 normal = normalized(area_vector(polygon));
  Vec3 sum;
  for (const Vec3& corner : polygon) sum += corner - polygon[0];
  return {normal, dot(normal, polygon[0] + sum / static_cast<double>(polygon.size()))};
}

bool is_convex(std::span<const Vec3> polygon) {
  const Vec3 area = area_vector(polygon);
  const double slack = -1e-9 * dot(area, area);
  const std::size_t n = polygon.size();
  for (std::size_t c = 0; c < n; ++c) {
    const Vec3 here = polygon[(c + 1) % n] - polygon[c], next = polygon[(c + 2) % n] - polygon[(c + 1) % n];
    if (dot(cross(here, next), area) < slack) return false;
  }
  return true;
}

ConvexPolygon part_above(const ConvexPolygon& polygon, const Plane& plane) {
  ConvexPolygon kept;
  const auto corners = polygon.corners();
  if (corners.empty()) return kept;
  Vec3 before = corners.back();
  double height_before = plane.height(before);
  for (const Vec3& here : corners) {
    const double height = plane.height(here);
    if ((height > 0 && height_before < 0) || (height < 0 && height_before > 0))
      kept.add(lerp(before, here, height_before / (height_before - height)));
    if (height >= 0) kept.add(here);
    before = here;
    height_before = height;
  }
  return kept;
}

ConvexPolygon part_inside(const ConvexPolygon& polygon, std::span<const Plane> sides, double slack) {
  ConvexPolygon inside = polygon;
  for (const Plane& side : sides) {
    if (inside.is_empty() || lies_below(inside.corners(), side, slack)) return {};
    if (!lies_above(inside.corners(), side, 0)) inside = part_above(inside, side);
  }
  return inside;
}

void move_part_below(ConvexPolygon& polygon, const Plane& plane, ConvexPolygon& below) {
  below.clear();
  std::array<double, ConvexPolygon::capacity> height;
  double lowest = 0, highest = 0;
  const std::size_t count = polygon.corners().size();
  for (std::size_t c = 0; c < count; ++c) {
    height[c] = plane.height(polygon.corners()[c]);
    lowest = std::min(lowest, height[c]), highest = std::max(highest, height[c]);
  }
  if (lowest == 0) return;
  if (highest == 0) {
    below = polygon;
    return polygon.clear();
  }
  ConvexPolygon above;
  for (std::size_t before = count - 1, here = 0; here < count; before = here++) {
    const Vec3 corner = polygon.corners()[here];
    if ((height[here] > 0 && height[before] < 0) || (height[here] < 0 && height[before] > 0)) {
      const Vec3 crossing = lerp(polygon.corners()[before], corner, height[before] / (height[before] - height[here]));
      above.add(crossing), below.add(crossing);
    }
    if (height[here] >= 0) above.add(corner);
    if (height[here] <= 0) below.add(corner);
  }
  polygon = above;
}

}  // namespace alvor
