#include "import/formats/placement.h"

#include "import/base/import_error.h"

#include <algorithm>

namespace alvor {

namespace {

constexpr std::size_t max_vertices = 200'000'000, max_corners = 800'000'000;

void refuse_beyond(std::size_t count, std::size_t limit, const std::string& what) {
  if (count > limit) throw ImportError("scene", "has more than " + std::to_string(limit) + " " + what);
}

}  // namespace

std::uint32_t add_placed_vertices(Scene& scene, std::span<const Vec3> vertices, const Placement& placement) {
  const std::size_t first = scene.vertices.size();
  refuse_beyond(first + vertices.size(), max_vertices, "vertices");
  for (const Vec3& vertex : vertices) scene.vertices.push_back(placement.point(vertex));
  return static_cast<std::uint32_t>(first);
}

void add_placed_face(Scene& scene, std::span<const std::uint32_t> polygon, std::uint32_t material, const Placement& placement,
                     std::span<const TexturePoint> points, std::span<const RgbF> colours) {
  refuse_beyond(scene.corners.size() + polygon.size(), max_corners, "corners");
  scene.add_face(polygon, material, points, colours);
  if (!placement.mirrors()) return;
  const auto all_but_first = static_cast<std::ptrdiff_t>(polygon.size()) - 1;
  std::reverse(scene.corners.end() - all_but_first, scene.corners.end());
  if (!points.empty()) std::reverse(scene.texture_points.end() - all_but_first, scene.texture_points.end());
  if (!colours.empty()) std::reverse(scene.corner_colours.end() - all_but_first, scene.corner_colours.end());
}

std::uint32_t add_object(Scene& scene, std::string name, std::optional<std::uint32_t> parent, const Placement& placement) {
  const auto number = static_cast<std::uint32_t>(scene.objects.size());
  scene.objects.push_back({std::move(name), parent, placement, static_cast<std::uint32_t>(scene.faces.size()), 0});
  return number;
}

void take_new_faces(Scene& scene, std::uint32_t which) {
  SceneObject& object = scene.objects[which];
  object.face_count = static_cast<std::uint32_t>(scene.faces.size()) - object.first_face;
}

std::uint32_t add_default_material(Scene& scene) {
  scene.materials.push_back({"default", {}, default_reflectance, false});
  return static_cast<std::uint32_t>(scene.materials.size() - 1);
}

}  // namespace alvor
