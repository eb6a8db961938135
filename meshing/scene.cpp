#include "meshing/scene.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string_view>
#include <unordered_set>

namespace alvor {

namespace {

constexpr double max_coordinate = 1e9;
// Each distant light lights every leaf by rays of its own, whatever it brings; an environment by those of three lights.
constexpr std::size_t most_distant_lights = 64, lights_of_environment = 3;
constexpr double rounding = 1e-6;      // of float32, in which files hold shares of light
constexpr double max_emission = 1e30;  // W/m2: after a million reflections the result still fits in a float

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", value);
  return text;
}

std::optional<std::string> fault_in_texture(const Material& material) {
  if (!material.texture) return std::nullopt;
  const Rgb& factor = material.texture->factor;
  for (const double band : {factor.r, factor.g, factor.b})
    if (!(band >= 0 && band <= 1)) return "factor " + number(band) + " of its texture is outside [0, 1]";
  return material.texture->image ? fault_in(*material.texture->image) : "its texture has no image";
}

std::optional<std::string> fault_in_transmittance(const Material& material) {
  const Rgb &straight = material.regular_transmittance, &scattered = material.diffuse_transmittance;
  const Rgb albedo = scattered + upper(material.reflectance, material.largest_reflectance()), all = straight + albedo;
  for (const double band : {straight.r, straight.g, straight.b})
    if (!(band >= 0 && band <= 1)) return "regular transmittance " + number(band) + " is outside [0, 1]";
  for (const double band : {scattered.r, scattered.g, scattered.b})
    if (!(band >= 0 && band < 1)) return "diffuse transmittance " + number(band) + " is outside [0, 1)";
  if (!(albedo.max() < 1))
    return "reflectance and diffuse transmittance are " + number(albedo.max()) + " together, must be below 1";
  if (all.max() > 1 + rounding) return "reflectance and transmittance are " + number(all.max()) + " together, beyond 1";
  if (material.is_translucent() && !material.two_sided) return "diffuse transmittance needs two sides";
  return std::nullopt;
}

std::optional<std::string> fault_in(const Material& material) {
  const double bands[2][3] = {{material.emission.r, material.emission.g, material.emission.b},
                              {material.reflectance.r, material.reflectance.g, material.reflectance.b}};
  for (const double emission : bands[0])
    if (!std::isfinite(emission) || emission < 0) return "emission " + number(emission) + " is not a finite value >= 0";
  for (const double emission : bands[0])
    if (emission > max_emission) return "emission " + number(emission) + " is beyond 1e30 W/m2";
  for (const double reflectance : bands[1])
    if (!(reflectance >= 0 && reflectance < 1)) return "reflectance " + number(reflectance) + " is outside [0, 1)";
  if (auto reason = fault_in_texture(material)) return reason;
  return fault_in_transmittance(material);
}

std::optional<std::string> fault_in(Vec3 vertex) {
  for (const double x : {vertex.x, vertex.y, vertex.z}) {
    if (!std::isfinite(x)) return "coordinate " + number(x) + " is not finite";
    if (std::abs(x) > max_coordinate) return "coordinate " + number(x) + " is beyond 1e9 m";
  }
  return std::nullopt;
}

std::optional<std::string> fault_in(const Face& face, const Scene& scene) {
  if (face.corner_count < 3) return "has " + std::to_string(face.corner_count) + " corners, needs at least 3";
  if (face.first_corner > scene.corners.size() || face.corner_count > scene.corners.size() - face.first_corner)
    return "its corners end beyond the list of corners";
  for (const std::uint32_t vertex : scene.corners_of(face))
    if (vertex >= scene.vertices.size())
      return "vertex index " + std::to_string(vertex) + " is out of range, there are " + std::to_string(scene.vertices.size()) +
             " vertices";
  if (face.material >= scene.materials.size())
    return "material index " + std::to_string(face.material) + " is out of range, there are " +
           std::to_string(scene.materials.size()) + " materials";
  return std::nullopt;
}

std::optional<Fault> fault_in_texture_points(const Scene& scene) {
  const auto has_texture = [](const Material& material) { return material.texture.has_value(); };
  const std::size_t wanted = std::ranges::any_of(scene.materials, has_texture) ? scene.corners.size() : 0;
  const std::size_t found = scene.texture_points.size();
  if (found < wanted || found > scene.corners.size())
    return Fault{"scene",
                 "has " + std::to_string(found) + " texture points for " + std::to_string(scene.corners.size()) + " corners"};
  for (std::size_t i = 0; i < scene.texture_points.size(); ++i)
    for (const float x : {scene.texture_points[i].s, scene.texture_points[i].t})
      if (!(std::abs(x) <= most_repeats))
        return Fault{"corner " + std::to_string(i), "its texture point " + number(x) + " is beyond 1e5"};
  return std::nullopt;
}

std::optional<Fault> fault_in_colours(const Scene& scene) {
  const std::size_t count = scene.corner_colours.size();
  if (count != 0 && count != scene.corners.size())
    return Fault{"scene", "has " + std::to_string(count) + " colours for " + std::to_string(scene.corners.size()) + " corners"};
  for (std::size_t i = 0; i < count; ++i)
    for (const float band : {scene.corner_colours[i].r, scene.corner_colours[i].g, scene.corner_colours[i].b})
      if (!(band >= 0 && band <= 1))
        return Fault{"corner " + std::to_string(i), "its colour " + number(band) + " is outside [0, 1]"};
  return std::nullopt;
}

std::optional<Fault> fault_in_objects(const Scene& scene) {
  std::unordered_set<std::string_view> names;
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    auto reason = fault_in(scene.objects, i, scene.faces.size());
    if (!reason && !names.insert(scene.objects[i].name).second) reason = "has the name of another object";
    if (reason) return Fault{"object " + std::to_string(i) + " '" + scene.objects[i].name + "'", *reason};
  }
  return std::nullopt;
}

}  // namespace

void Scene::add_face(std::span<const std::uint32_t> polygon, std::uint32_t material, std::span<const TexturePoint> points,
                     std::span<const RgbF> colours) {
  faces.push_back({static_cast<std::uint32_t>(corners.size()), static_cast<std::uint32_t>(polygon.size()), material});
  constexpr RgbF white{1, 1, 1};
  if (!points.empty()) texture_points.resize(corners.size());
  if (!colours.empty()) corner_colours.resize(corners.size(), white);
  corners.insert(corners.end(), polygon.begin(), polygon.end());
  texture_points.insert(texture_points.end(), points.begin(), points.end());
  if (!texture_points.empty()) texture_points.resize(corners.size());
  corner_colours.insert(corner_colours.end(), colours.begin(), colours.end());
  if (!corner_colours.empty()) corner_colours.resize(corners.size(), white);
}

void Scene::add_polygon(std::span<const Vec3> polygon, std::uint32_t material) {
  std::vector<std::uint32_t> ring;
  for (const Vec3& corner : polygon) {
    ring.push_back(static_cast<std::uint32_t>(vertices.size()));
    vertices.push_back(corner);
  }
  add_face(ring, material);
}

std::optional<Fault> find_fault(const Scene& scene) {
  if (scene.faces.empty()) return Fault{"scene", "has no faces"};
  if (!std::isfinite(scene.north_degrees)) return Fault{"scene", "its north is not a finite number of degrees"};
  if (!scene.absorption.is_finite() || scene.absorption.min() < 0) return Fault{"absorption", "is not a finite number >= 0"};
  for (std::size_t i = 0; i < scene.materials.size(); ++i)
    if (auto reason = fault_in(scene.materials[i]))
      return Fault{"material " + std::to_string(i) + " '" + scene.materials[i].name + "'", *reason};
  std::size_t count = 0;
  for (const Light& light : scene.lights)
    if (light.is_distant()) count += light.kind == LightKind::environment ? lights_of_environment : 1;
  if (count > most_distant_lights)
    return Fault{"scene",
                 "has " + std::to_string(count) + " distant lights (an environment counts as three), at most 64 are possible"};
  std::unordered_set<const void*> sound;  // webs and maps, which many lights share
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const Light& light = scene.lights[i];
    std::optional<std::string> reason;
    if (light.web && sound.insert(light.web.get()).second) reason = fault_in(*light.web);
    if (!reason && light.environment && sound.insert(light.environment.get()).second) reason = fault_in(*light.environment);
    if (!reason) reason = fault_in_all_but_shared(light);
    if (reason) return Fault{"light " + std::to_string(i) + " '" + light.name + "'", *reason};
  }
  for (std::size_t i = 0; i < scene.vertices.size(); ++i)
    if (auto reason = fault_in(scene.vertices[i])) return Fault{"vertex " + std::to_string(i), *reason};
  for (std::size_t i = 0; i < scene.faces.size(); ++i)
    if (auto reason = fault_in(scene.faces[i], scene)) return Fault{"face " + std::to_string(i), *reason};
  if (auto fault = fault_in_texture_points(scene)) return fault;
  if (auto fault = fault_in_colours(scene)) return fault;
  return fault_in_objects(scene);
}

}  // namespace alvor
