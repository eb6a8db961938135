#include "client/report/luminaire_list.h"

#include "client/picture/units.h"

#include <algorithm>
#include <cmath>

namespace alvor {

namespace {

/// Returns whether two lights are of one type. A lamp's name, place and aim do not matter.
bool is_same_type(const Light& a, const Light& b) {
  return a.kind == b.kind && a.web == b.web && a.intensity == b.intensity && a.opening == b.opening && a.radius == b.radius &&
         a.inner_cone == b.inner_cone && a.outer_cone == b.outer_cone && a.electrical_watts == b.electrical_watts;
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

std::vector<EmittingMaterial> emitting_materials(const DisplayMesh& mesh) {
  std::vector<double> areas(mesh.materials.size());
  std::size_t triangle = 0;
  for (const FaceTriangles& run : mesh.faces)
    for (std::uint32_t n = 0; n < run.count; ++n, ++triangle) {
      if (run.material >= areas.size()) continue;
      const auto& [a, b, c] = mesh.triangles[triangle];
      const Vec3 corner = mesh.positions[a];
      areas[run.material] += length(cross(mesh.positions[b] - corner, mesh.positions[c] - corner)) / 2;
    }
  std::vector<EmittingMaterial> emitting;
  for (std::size_t m = 0; m < areas.size(); ++m) {
    const double exitance = one_number(mesh.materials[m].emission, mesh.quantity);
    if (exitance > 0 && areas[m] > 0) emitting.push_back({mesh.materials[m].name, areas[m], areas[m] * exitance});
  }
  return emitting;
}

bool is_in(const Room& room, const Light& light) {
  if (light.is_distant()) return false;
  constexpr double above_ceiling = 0.5;  // metres: recessed luminaires are in the room below
  const double height = dot(light.position, room.frame.up) - room.floor_height;
  return height > 0 && height < room.clear_height + above_ceiling &&
         room.cell_at(dot(light.position, room.frame.u), dot(light.position, room.frame.v)) != Room::Cell::elsewhere;
}

RoomPower power_in(const Room& room, const DisplayMesh& mesh) {
  RoomPower power;
  for (const Light& light : mesh.lights) {
    if (!is_in(room, light)) continue;
    ++power.luminaires;
    power.watts += light.electrical_watts;
    power.is_complete &= light.electrical_watts > 0;
  }
  return power;
}

}  // namespace alvor
