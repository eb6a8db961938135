#include "meshing/mesh_transmittance.h"

#include "meshing/mesh_radiosity.h"

namespace alvor {

MeshTransmittance::MeshTransmittance(const DisplayMesh& mesh) : mesh_(mesh), panes_(panes_of(mesh)) {}

Rgb MeshTransmittance::at(std::uint32_t triangle, double u, double v) const {
  const Material* const material = pane(triangle);
  if (!material) return {};
  const double there = opacity_at(triangle, u, v), hole = 1 - there;
  return there * material->regular_transmittance + Rgb{hole, hole, hole};
}

double MeshTransmittance::opacity_at(std::uint32_t triangle, double u, double v) const {
  const Material* const material = pane(triangle);
  if (!material || !material->has_cutout() || mesh_.texture_points.empty()) return 1;
  return material->texture->opacity_at(texture_point_at(mesh_, triangle, u, v));
}

}  // namespace alvor
