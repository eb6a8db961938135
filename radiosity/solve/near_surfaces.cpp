#include "radiosity/solve/near_surfaces.h"

#include "radiosity/rays/ray_source.h"
#include "radiosity/rays/unit_disk.h"

#include <cmath>
#include <limits>

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

}  // namespace alvor
