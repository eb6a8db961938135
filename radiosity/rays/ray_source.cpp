#include "radiosity/rays/ray_source.h"

namespace alvor {

PatchPoints sample_points(const LocalScene& scene, const PatchShape& patch, RandomStream& random) {
  const LocalRoot& root = scene.root(patch.root);
  const Uv jitter{random.next() - 0.5, random.next() - 0.5};
  const OriginPlaces origins = origins_in(patch, jitter);
  const auto &u = origins.u, &v = origins.v;
  PatchPoints points;
  const auto along = [&](float origin, float edge_u, float edge_v, float twist, float normal, float* out) {
    for (int o = 0; o < origins_per_patch; ++o)
      out[o] = origin + u[o] * edge_u + v[o] * edge_v + u[o] * v[o] * twist + ray_offset * normal;
  };
  along(root.origin.x, root.edge_u.x, root.edge_v.x, root.twist.x, root.normal.x, points.x);
  along(root.origin.y, root.edge_u.y, root.edge_v.y, root.twist.y, root.normal.y, points.y);
  along(root.origin.z, root.edge_u.z, root.edge_v.z, root.twist.z, root.normal.z, points.z);
  return points;
}

}  // namespace alvor
