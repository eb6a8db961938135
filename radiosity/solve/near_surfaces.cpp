#include "radiosity/solve/near_surfaces.h"

#include "radiosity/rays/ray_source.h"
#include "radiosity/rays/unit_disk.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace alvor {

double near_distance(const LocalScene& scene, const PatchShape& patch, PatchId id, std::uint64_t seed) {
  static_assert(rays_to_near_surfaces == RayPacket::width);
  constexpr float far = 4;         // leaves the scene from everywhere in it
  constexpr std::size_t side = 4;  // of the grid of strata
  RandomStream random(seed, id);
  const Vec3 normal = scene.mesh().roots()[patch.root].normal;
  const Vec3 from = scene.frame().to_local(centre_of(scene.mesh(), patch)) + double(ray_offset) * normal;
  RayPacket rays;
  for (std::size_t n = 0; n < rays_to_near_surfaces; ++n) {
    const double u = (static_cast<double>(n % side) + random.next()) / side,
                 v = (static_cast<double>(n / side) + random.next()) / side;
    rays.set(n, from, cosine_direction(normal, {u, v}), far);
  }
  HitPacket hits;
  scene.visibility().closest_hits({&rays, 1}, {&hits, 1});
  double inverse = 0;
  for (std::size_t n = 0; n < rays_to_near_surfaces; ++n)
    if (hits.root[n] != HitPacket::nothing) inverse += 1 / std::max(double(hits.t[n]), double(ray_offset));
  if (inverse == 0) return std::numeric_limits<double>::infinity();
  return scene.frame().metres_per_unit * double(rays_to_near_surfaces) / inverse;
}

double gap_before(const BaseMesh& mesh, std::uint32_t root, Vec3 centre, const TransportRow& row) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  if (row.origin_hits.empty()) return infinite;
  std::vector<std::pair<double, double>> heights;  // with the weights of rays
  for (std::size_t h = 0; h < row.hits.size(); ++h) {
    if (mesh.material_of(row.hits[h].root_face()).is_pane()) continue;
    const Vec3 there = centre_of(mesh, shape_of(mesh, row.hits[h]));
    heights.emplace_back(dot(there - centre, mesh.roots()[root].normal), row.hit_weight.empty() ? 1 : row.hit_weight[h].mean());
  }
  std::ranges::sort(heights);
  double left = row.ray_count() / 2.0;
  for (const auto& [height, weight] : heights)
    if ((left -= weight) <= 0) return std::max(0.0, height);
  return infinite;
}

}  // namespace alvor
