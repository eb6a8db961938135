#include "radiosity/direct/lights_of_scene.h"

#include "radiosity/direct/distant_light.h"
#include "radiosity/direct/face_light.h"
#include "radiosity/direct/lamp_light.h"
#include "radiosity/direct/opening_light.h"
#include "radiosity/direct/sky_light.h"

namespace alvor {

namespace {

bool shines_from_area(const Light& light) {
  using Shape = LuminousOpening::Shape;
  return light.kind == LightKind::luminaire && light.opening.shape != Shape::point && light.opening.shape != Shape::sphere;
}

/// Makes the lights of skies; where they enter the scene is found once for all of them.
class SkyLights {
 public:
  SkyLights(const LocalScene& scene, const EmissionUnit& unit, OwnedLights& lights)
      : scene_(scene), unit_(unit), lights_(lights) {}

  void add(const Light& sky, std::uint32_t& number) {
    if (!exits_) exits_ = std::make_shared<SkyExits>(scene_);
    if (exits_->any_open) lights_.push_back(std::make_unique<DomeLight>(scene_, number++, sky, unit_, exits_));
    for (std::size_t which = 0; which < exits_->exits.size(); ++which)
      lights_.push_back(std::make_unique<ExitLight>(scene_, number++, sky, unit_, exits_, which));
  }

 private:
  const LocalScene& scene_;
  const EmissionUnit& unit_;
  OwnedLights& lights_;
  std::shared_ptr<const SkyExits> exits_;
};

}  // namespace

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
  SkyLights skies(scene, unit, lights);
  for (const Light& light : scene.mesh().lights()) {
    if (light.intensity.is_zero()) continue;
    if (light.kind == LightKind::sky) skies.add(light, number);
    else if (light.is_distant()) lights.push_back(std::make_unique<DistantLight>(scene, number++, light, unit));
    else if (shines_from_area(light)) lights.push_back(std::make_unique<OpeningLight>(scene, number++, light, unit));
    else lights.push_back(std::make_unique<LampLight>(scene, number++, light, unit));
  }
  return lights;
}

}  // namespace alvor
