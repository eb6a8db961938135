#include "radiosity/direct/lights_of_scene.h"

#include "radiosity/direct/distant_light.h"
#include "radiosity/direct/face_light.h"
#include "radiosity/direct/lamp_light.h"

namespace alvor {

OwnedLights lights_of_faces(const LocalScene& scene, const EmissionUnit& unit) {
  OwnedLights lights;
  for (std::uint32_t root = 0; root < scene.mesh().roots().size(); ++root) {
    const Rgb emission = unit.from_watts_per_m2(scene.mesh().material_of(root).emission);
    if (!emission.is_zero()) lights.push_back(std::make_unique<FaceLight>(scene, root, emission));
  }
  return lights;
}

OwnedLights lights_beside_faces(const LocalScene& scene, const EmissionUnit& unit) {
  OwnedLights lights;
  auto number = static_cast<std::uint32_t>(scene.mesh().roots().size());
  for (const Light& light : scene.mesh().lights()) {
    if (light.intensity.is_zero()) continue;
    if (light.is_distant()) lights.push_back(std::make_unique<DistantLight>(scene, number++, light, unit));
    else lights.push_back(std::make_unique<LampLight>(scene, number++, light, unit));
  }
  return lights;
}

}  // namespace alvor
