#include "radiosity/rays/cutouts.h"

#include "meshing/polygon.h"

#include <algorithm>

namespace alvor {

Cutouts::Cutouts(const BaseMesh& mesh) {
  if (std::ranges::none_of(mesh.materials(), &Material::has_cutout)) return;
  roots_.resize(mesh.roots().size());
  for (std::uint32_t r = 0; r < roots_.size(); ++r) {
    const RootPatch& root = mesh.roots()[r];
    const Material& material = mesh.material_of(r);
    if (!material.has_cutout()) continue;
    Placed& placed = roots_[r].emplace(Placed{&*material.texture, mesh.texture_points(r), root.corner_count == 4, 0, 0});
    if (!placed.is_quad) continue;
    const auto fourth = barycentric(root.corners[3], root.corners[0], root.corners[1], root.corners[2]);
    placed.fourth_a = static_cast<float>(fourth[1]), placed.fourth_b = static_cast<float>(fourth[2]);
  }
}

// Embree cuts a quad into (corner 0, 1, 3), where u and v count from corner 0 along the edges, and (2, 3, 1), where 1 - u and
// 1 - v count from corner 2.
float Cutouts::opacity(const Placed& placed, float u, float v) {
  const auto& p = placed.points;
  float a = u, b = v;
  if (placed.is_quad) {
    const float far_u = 1 - u, far_v = 1 - v, x = placed.fourth_a, y = placed.fourth_b;
    const bool is_first = u + v <= 1;
    a = is_first ? u + v * x : far_u * x + far_v;
    b = is_first ? v * y : 1 + far_u * (y - 1) - far_v;
  }
  // On the first triangle the weights of corners 1 and 2 are a and b; on the other those of corners 3 and 2 are `second`,
  // `third`.
  const bool is_second = placed.is_quad && a < 0;
  const float second = is_second ? a / placed.fourth_a : a, third = is_second ? b - second * placed.fourth_b : b;
  const TexturePoint& q = is_second ? p[3] : p[1];
  return static_cast<float>(placed.texture->opacity_at({p[0].s + second * (q.s - p[0].s) + third * (p[2].s - p[0].s),
                                                        p[0].t + second * (q.t - p[0].t) + third * (p[2].t - p[0].t)}));
}

}  // namespace alvor
