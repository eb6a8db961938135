#include "meshing/mesh_radiosity.h"

#include <algorithm>

namespace alvor {

namespace {

Rgb mixed(const DisplayMesh& mesh, const std::vector<RgbF>& values, std::uint32_t triangle, double u, double v) {
  const std::array<std::uint32_t, 3>& corners = mesh.triangles[triangle];
  return (1 - u - v) * widen(values[corners[0]]) + u * widen(values[corners[1]]) + v * widen(values[corners[2]]);
}

}  // namespace

TexturePoint texture_point_at(const DisplayMesh& mesh, std::uint32_t triangle, double u, double v) {
  const std::array<std::uint32_t, 3>& corners = mesh.triangles[triangle];
  const auto& points = mesh.texture_points;
  const auto axis = [&](float TexturePoint::*which) {
    return static_cast<float>((1 - u - v) * points[corners[0]].*which + u * points[corners[1]].*which +
                              v * points[corners[2]].*which);
  };
  return {axis(&TexturePoint::s), axis(&TexturePoint::t)};
}

MeshRadiosity::MeshRadiosity(const DisplayMesh& mesh) : mesh_(mesh), textured_(textured_of(mesh)) {}

Rgb MeshRadiosity::at(std::uint32_t triangle, double u, double v) const {
  const Rgb there = of_what_is_there(triangle, u, v);
  const Material* const material = textured(triangle);
  return material && material->has_cutout() ? material->texture->opacity_at(texture_point_at(mesh_, triangle, u, v)) * there
                                            : there;
}

// Vertices have the mean reflectance of their material. Light that comes through from behind does not depend on it.
Rgb MeshRadiosity::of_what_is_there(std::uint32_t triangle, double u, double v) const {
  const Rgb mean = mixed(mesh_, mesh_.radiosity, triangle, u, v);
  const Material* const material = textured(triangle);
  if (!material) return mean;
  const Rgb here = material->texture->reflectance_at(texture_point_at(mesh_, triangle, u, v));
  const Rgb through = mesh_.transmitted.empty() ? Rgb{} : mixed(mesh_, mesh_.transmitted, triangle, u, v);
  const auto band = [](double not_reflected, double all, double texel, double usual) {
    return not_reflected + (usual > 0 ? std::max(0.0, all - not_reflected) * texel / usual : 0);
  };
  const Rgb other = material->emission + through, &rho = material->reflectance;
  return {band(other.r, mean.r, here.r, rho.r), band(other.g, mean.g, here.g, rho.g), band(other.b, mean.b, here.b, rho.b)};
}

}  // namespace alvor
