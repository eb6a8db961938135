#include "radiosity/direct/lights_of_scene.h"

#include "radiosity/direct/distant_light.h"
#include "radiosity/direct/face_light.h"
#include "radiosity/direct/lamp_light.h"

namespace alvor {

namespace {

/// Returns the light of a point or spot lamp.
std::unique_ptr<const LightSource> light_of(const LocalScene& scene, std::uint32_t number, const Light& lamp,
                                            const EmissionUnit& unit) {
  const double metres = scene.frame().metres_per_unit;
  const RelativeLight at_one_local_unit = unit.from_watts_per_m2((1 / (metres * metres)) * lamp.intensity);
  const RelativeLight power = unit.from_watts_per_m2(radiated_power(lamp));
  return std::make_unique<LampLight>(scene, number, lamp, at_one_local_unit, power.sum());
}

}  // namespace

std::vector<RelativeLight> emission_by_material(const BaseMesh& mesh, const EmissionUnit& unit) {
  std::vector<RelativeLight> emission;
  for (const Material& material : mesh.materials()) emission.push_back(unit.from_watts_per_m2(material.emission));
  return emission;
}

OwnedLights lights_of_faces(const LocalScene& scene, const EmissionUnit& unit) {
  OwnedLights lights;
  const auto emission_of = emission_by_material(scene.mesh(), unit);
  for (std::uint32_t root = 0; root < scene.mesh().roots().size(); ++root) {
    const RelativeLight& emission = emission_of[scene.mesh().roots()[root].material];
    if (!emission.is_zero()) lights.push_back(std::make_unique<FaceLight>(scene, root, emission));
  }
  return lights;
}

OwnedLights lights_beside_faces(const LocalScene& scene, const EmissionUnit& unit) {
  OwnedLights lights;
  auto number = static_cast<std::uint32_t>(scene.mesh().roots().size());
  for (const Light& light : scene.mesh().lights()) {
    if (light.intensity.is_zero()) continue;
    if (light.is_distant())
      lights.push_back(std::make_unique<DistantLight>(scene, number++, light, unit.from_watts_per_m2(light.intensity)));
    else lights.push_back(light_of(scene, number++, light, unit));
  }
  return lights;
}

}  // namespace alvor
