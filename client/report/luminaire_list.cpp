#include "client/report/luminaire_list.h"

#include "client/picture/units.h"
#include "meshing/mesh_area.h"

#include <algorithm>
#include <cmath>

namespace alvor {

namespace {

/// Returns whether two lights are of one type. A lamp's name, place and aim do not matter.
bool is_same_type(const Light& a, const Light& b) {
  return a.kind == b.kind && a.web == b.web && a.intensity == b.intensity && a.opening == b.opening && a.radius == b.radius &&
         a.inner_cone == b.inner_cone && a.outer_cone == b.outer_cone && a.electrical_watts == b.electrical_watts;
}

/// Returns the area of each material, m2.
std::vector<double> areas_of_materials(const DisplayMesh& mesh) {
  std::vector<double> areas(mesh.materials.size());
  std::uint32_t triangle = 0;
  for (const FaceTriangles& run : mesh.faces)
    for (std::uint32_t n = 0; n < run.count; ++n, ++triangle)
      if (run.material < areas.size()) areas[run.material] += area_of(mesh, triangle);
  return areas;
}

}  // namespace

std::vector<LuminaireType> luminaire_types(const DisplayMesh& mesh) {
  std::vector<LuminaireType> types;
  std::vector<const Light*> first;
  for (const Light& light : mesh.lights) {
    if (light.is_distant()) continue;
    const auto known = std::ranges::find_if(first, [&](const Light* other) { return is_same_type(*other, light); });
    if (known == first.end()) {
      first.push_back(&light);
      types.push_back({light.name, light.kind, 1, one_number(radiated_power(light), mesh.quantity), light.electrical_watts});
    } else {
      ++types[static_cast<std::size_t>(known - first.begin())].count;
    }
  }
  return types;
}

std::vector<SurfaceMaterial> surface_materials(const DisplayMesh& mesh) {
  const std::vector<double> areas = areas_of_materials(mesh);
  std::vector<SurfaceMaterial> surfaces;
  for (std::size_t m = 0; m < areas.size(); ++m)
    if (areas[m] > 0)
      surfaces.push_back({mesh.materials[m].name, one_number(mesh.materials[m].reflectance, mesh.quantity), areas[m]});
  std::ranges::stable_sort(surfaces, std::ranges::greater{}, &SurfaceMaterial::area);
  return surfaces;
}

std::vector<EmittingMaterial> emitting_materials(const DisplayMesh& mesh) {
  const std::vector<double> areas = areas_of_materials(mesh);
  std::vector<EmittingMaterial> emitting;
  for (std::size_t m = 0; m < areas.size(); ++m) {
    const double exitance = one_number(mesh.materials[m].emission, mesh.quantity);
    if (exitance > 0 && areas[m] > 0) emitting.push_back({mesh.materials[m].name, areas[m], areas[m] * exitance});
  }
  return emitting;
}

std::vector<std::vector<const Light*>> lights_in(std::span<const Room> rooms, const DisplayMesh& mesh) {
  std::vector<std::vector<const Light*>> by_room(rooms.size());
  for (const Light& light : mesh.lights)
    if (const auto room = light.is_distant() ? std::nullopt : room_at(rooms, light.position)) by_room[*room].push_back(&light);
  return by_room;
}

RoomPower power_of(std::span<const Light* const> lights) {
  RoomPower power{lights.size()};
  for (const Light* light : lights) {
    power.watts += light->electrical_watts;
    power.is_complete &= light->electrical_watts > 0;
  }
  return power;
}

}  // namespace alvor
