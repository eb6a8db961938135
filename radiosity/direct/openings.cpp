#include "radiosity/direct/openings.h"

#include "radiosity/direct/crossing_groups.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

namespace alvor {

namespace {

// Most planes of faces and of panes that are looked at, those with the largest area: comparing 2^16 rays with 100 planes takes
// 0.1 s. Most openings; what they leave comes through the sides of the bounding box.
constexpr std::size_t most_planes = 48, most_openings = 36;
// Steps in which planes are told apart: of a unit normal's coordinates, and of distances, local units.
constexpr double normal_step = 1e-4, distance_step = 1e-4;

/// Roots that lie in one plane.
struct Plane {
  std::vector<std::uint32_t> roots;
  double area = 0;
};

/// Returns the planes of the largest faces, of panes or of all others.
std::vector<Plane> planes_of(const LocalScene& scene, bool of_panes) {
  std::map<std::array<long, 4>, Plane> planes;
  for (std::uint32_t root = 0; root < scene.mesh().roots().size(); ++root) {
    const RootPatch& patch = scene.mesh().roots()[root];
    const Material& material = scene.mesh().material_of(root);
    if (patch.is_behind || material.has_cutout() || material.is_pane() != of_panes) continue;
    Vec3 normal = patch.normal;
    if (std::array{normal.x, normal.y, normal.z} < std::array{-normal.x, -normal.y, -normal.z}) normal = -normal;
    const double distance = dot(normal, scene.corners(root)[0]);
    Plane& plane = planes[{std::lround(normal.x / normal_step), std::lround(normal.y / normal_step),
                           std::lround(normal.z / normal_step), std::lround(distance / distance_step)}];
    plane.roots.push_back(root);
    plane.area += patch.area;
  }
  std::vector<Plane> largest;
  for (auto& [key, plane] : planes) largest.push_back(std::move(plane));
  std::ranges::stable_sort(largest, std::greater(), &Plane::area);
  if (largest.size() > most_planes) largest.resize(most_planes);
  return largest;
}

/// Returns the rectangle about the faces of a plane whose sides lie along `u` (unit, in the plane) and across it.
FlatRectangle rectangle_along(const LocalScene& scene, const Plane& plane, Vec3 normal, Vec3 u) {
  const Vec3 v = cross(normal, u), start = scene.corners(plane.roots[0])[0];
  Uv low{0, 0}, high{0, 0};
  for (const std::uint32_t root : plane.roots)
    for (const Vec3 corner : scene.corners(root)) {
      const Uv at{dot(corner - start, u), dot(corner - start, v)};
      low = {std::min(low.u, at.u), std::min(low.v, at.v)};
      high = {std::max(high.u, at.u), std::max(high.v, at.v)};
    }
  return {start + low.u * u + low.v * v, (high.u - low.u) * u, (high.v - low.v) * v, normal};
}

/// Returns the smallest rectangle about the faces of a plane that is parallel to an edge of the largest face.
FlatRectangle rectangle_about(const LocalScene& scene, const Plane& plane) {
  const std::uint32_t largest =
      *std::ranges::max_element(plane.roots, {}, [&](std::uint32_t root) { return scene.mesh().roots()[root].area; });
  const auto corners = scene.corners(largest);
  const Vec3 normal = scene.mesh().roots()[largest].normal;
  FlatRectangle smallest;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t c = 0; c < corners.size(); ++c) {
    const Vec3 edge = corners[(c + 1) % corners.size()] - corners[c];
    const Vec3 u = normalized(edge - dot(edge, normal) * normal);
    const FlatRectangle rectangle = rectangle_along(scene, plane, normal, u);
    if (rectangle.area() < (1 - 1e-9) * least) smallest = rectangle, least = rectangle.area();
  }
  return smallest;
}

std::vector<FlatRectangle> sides_of(const SceneBox& box) {
  const Vec3 size = box.high - box.low, x{size.x, 0, 0}, y{0, size.y, 0}, z{0, 0, size.z};
  std::vector<FlatRectangle> sides;
  for (const Vec3 corner : {box.low, box.high}) {
    const double way = corner == box.low ? 1 : -1;
    sides.push_back({corner, way * y, way * z, {1, 0, 0}});
    sides.push_back({corner, way * z, way * x, {0, 1, 0}});
    sides.push_back({corner, way * x, way * y, {0, 0, 1}});
  }
  return sides;
}

/// A rectangle through which rays left, and of the rays that would cross it if nothing stood in their way, the share that left.
struct Opening {
  FlatRectangle rectangle;
  double share = 0;
};

/// Returns the openings in one plane: about groups of places where rays that left crossed it.
std::vector<Opening> openings_in(const FlatRectangle& plane, std::span<const ProbeRay> left, std::span<const ProbeRay> stayed) {
  const auto crossings = [&](std::span<const ProbeRay> rays) {
    std::vector<Uv> places;
    for (const ProbeRay& ray : rays)
      if (const auto at = plane.crossing(ray.from, ray.direction)) places.push_back(*at);
    return places;
  };
  const std::vector<RectangleOfPlaces> groups = group_places(crossings(left));
  if (groups.empty()) return {};
  const std::vector<Uv> blocked = crossings(stayed);
  std::vector<Opening> openings;
  for (const RectangleOfPlaces& group : groups) {
    const auto held = std::ranges::count_if(blocked, [&](Uv at) { return group.holds(at); });
    const auto count = static_cast<double>(group.places);
    openings.push_back({plane.part(group.low_u, group.high_u, group.low_v, group.high_v),
                        count / (count + ProbeRays::each_stayed * static_cast<double>(held))});
  }
  return openings;
}

}  // namespace

std::vector<FlatRectangle> find_openings(const LocalScene& scene, const SceneBox& box, const ProbeRays& rays) {
  if (rays.left.empty()) return {};
  const std::vector<FlatRectangle> sides = sides_of(box);
  std::vector<FlatRectangle> planes = sides;
  for (const bool of_panes : {false, true})
    for (const Plane& plane : planes_of(scene, of_panes)) planes.push_back(rectangle_about(scene, plane));

  std::vector<std::vector<Opening>> in_plane(planes.size());
  tbb::parallel_for(std::size_t{0}, planes.size(),
                    [&](std::size_t n) { in_plane[n] = openings_in(planes[n], rays.left, rays.stayed); });
  std::vector<Opening> candidates;
  for (const std::vector<Opening>& openings : in_plane) candidates.insert(candidates.end(), openings.begin(), openings.end());
  std::ranges::stable_sort(candidates, std::greater(), &Opening::share);

  // Takes the candidates through which rays leave that left through none before.
  std::vector<ProbeRay> left = rays.left;
  std::vector<FlatRectangle> openings;
  const auto take = [&](const FlatRectangle& rectangle) {
    const auto crosses = [&](const ProbeRay& ray) { return rectangle.crossing(ray.from, ray.direction).has_value(); };
    if (std::erase_if(left, crosses) > 0) openings.push_back(rectangle);
  };
  for (std::size_t n = 0; n < candidates.size() && openings.size() < most_openings && !left.empty(); ++n)
    take(candidates[n].rectangle);
  for (const FlatRectangle& side : sides)
    for (const Opening& opening : openings_in(side, std::vector(left), {})) take(opening.rectangle);
  return openings;
}

}  // namespace alvor
