#include "client/verify/surface_points.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>

namespace alvor {

namespace {

/// Returns the running sums of the facets' areas; two-sided facets count twice.
std::vector<double> running_area(const Scene& scene, std::span<const Facet> facets) {
  std::vector<double> sums;
  double sum = 0;
  for (const Facet& facet : facets)
    sums.push_back(sum += facet.area * (scene.materials[scene.faces[facet.face].material].two_sided ? 2 : 1));
  return sums;
}

SurfacePoint draw(const Facet& facet, bool two_sided, PathRandom& random) {
  const double edge = std::sqrt(random.number()), along = random.number();
  const bool back = two_sided && random.number() < 0.5;
  return {facet.at(edge * (1 - along), edge * along), back ? -facet.normal : facet.normal, facet.face};
}

}  // namespace

std::vector<SurfacePoint> draw_surface_points(const Scene& scene, std::size_t count, std::uint64_t seed) {
  const std::vector<Facet> facets = facets_of(scene);
  const std::vector<double> areas = running_area(scene, facets);
  constexpr std::uint64_t own_stream = ~0ull;  // no path uses this stream
  std::vector<SurfacePoint> points;
  points.reserve(count);
  for (std::size_t n = 0; n < count; ++n) {
    PathRandom random(seed, n, own_stream);
    const auto found = std::ranges::upper_bound(areas, random.number() * areas.back());
    const Facet& facet = facets[static_cast<std::size_t>(std::min(found, std::prev(areas.end())) - areas.begin())];
    points.push_back(draw(facet, scene.materials[scene.faces[facet.face].material].two_sided, random));
  }
  return points;
}

}  // namespace alvor
