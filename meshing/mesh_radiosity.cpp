#include "meshing/mesh_radiosity.h"

#include <algorithm>

namespace alvor {

MeshRadiosity::MeshRadiosity(const DisplayMesh& mesh) : mesh_(mesh), textured_(textured_of(mesh)) {}

// Vertices have the mean reflectance of their material.
Rgb MeshRadiosity::at(std::uint32_t triangle, double u, double v) const {
  const std::uint32_t a = mesh_.triangles[triangle][0], b = mesh_.triangles[triangle][1], c = mesh_.triangles[triangle][2];
  const double w = 1 - u - v;
  const auto mixed = [&](const std::vector<RgbF>& values) {
    return w * widen(values[a]) + u * widen(values[b]) + v * widen(values[c]);
  };
  const Rgb mean = mixed(mesh_.radiosity);
  if (textured_.empty() || !textured_[triangle]) return mean;
  const auto& points = mesh_.texture_points;
  const auto point = [&](float TexturePoint::*axis) {
    return static_cast<float>(w * points[a].*axis + u * points[b].*axis + v * points[c].*axis);
  };
  const Material& material = *textured_[triangle];
  const Rgb here = material.texture->reflectance_at({point(&TexturePoint::s), point(&TexturePoint::t)});
  const auto band = [](double emission, double all, double texel, double usual) {
    return emission + (usual > 0 ? std::max(0.0, all - emission) * texel / usual : 0);
  };
  const Rgb &e = material.emission, &rho = material.reflectance;
  return {band(e.r, mean.r, here.r, rho.r), band(e.g, mean.g, here.g, rho.g), band(e.b, mean.b, here.b, rho.b)};
}

}  // namespace alvor
