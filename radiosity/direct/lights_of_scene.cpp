#include "radiosity/direct/lights_of_scene.h"

#include "radiosity/direct/distant_light.h"
#include "radiosity/direct/environment_light.h"
#include "radiosity/direct/face_light.h"
#include "radiosity/direct/lamp_light.h"
#include "radiosity/direct/mesh_light.h"
#include "radiosity/direct/opening_light.h"
#include "radiosity/direct/sky_light.h"

#include <algorithm>
#include <numbers>
#include <unordered_map>

namespace alvor {

namespace {

bool shines_from_area(const Light& light) {
  using Shape = LuminousOpening::Shape;
  return light.kind == LightKind::luminaire && light.opening.shape != Shape::point && light.opening.shape != Shape::sphere;
}

/// Makes the lights of one scene that are not faces.
class LightMaker {
 public:
  LightMaker(const LocalScene& scene, const EmissionUnit& unit)
      : scene_(scene), unit_(unit), number_(static_cast<std::uint32_t>(scene.mesh().roots().size())) {}

  void add(const Light& light) {
    if (light.kind == LightKind::sky) add_sky(light);
    else if (light.kind == LightKind::environment) add_environment(light);
    else if (light.is_distant()) make<DistantLight>(light, unit_.from_watts_per_m2(light.intensity));
    else add_lamp(light);
  }
  /// Keeps the number of a lamp or a sun that is black, so that those of the others do not change when it is switched off.
  void skip(const Light& light) { number_ += light.kind != LightKind::sky && light.kind != LightKind::environment; }
  OwnedLights take() { return std::move(lights_); }

 private:
  template <class Kind, class... Arguments>
  void make(Arguments&&... arguments) {
    lights_.push_back(std::make_unique<Kind>(scene_, number_++, std::forward<Arguments>(arguments)...));
  }
  void add_lamp(const Light& lamp) {
    const double metres = scene_.frame().metres_per_unit;
    const RelativeLight at_one_local_unit = unit_.from_watts_per_m2((1 / (metres * metres)) * lamp.intensity);
    const WebSums sums = lamp.web ? sums_of(*lamp.web) : WebSums{};
    const double power = unit_.from_watts_per_m2(lamp.web ? sums.flux * lamp.intensity : radiated_power(lamp)).sum();
    if (shines_from_area(lamp)) make<OpeningLight>(lamp, at_one_local_unit, power, sums.greatest);
    else make<LampLight>(lamp, at_one_local_unit, power, sums.greatest);
  }
  /// Sums over a whole web. Many lamps may share one.
  struct WebSums {
    double flux = 0, greatest = 1;
  };
  const WebSums& sums_of(const PhotometricWeb& web) {
    const auto [sums, is_new] = sums_.try_emplace(&web);
    if (is_new) sums->second = {web.flux(), web.greatest()};
    return sums->second;
  }
  /// Returns the places where light of skies and environments enters the scene: the same for all of them, found once.
  const SkyExits& exits() {
    if (!exits_) exits_ = std::make_shared<SkyExits>(scene_, ways_out_);
    return *exits_;
  }
  void add_sky(const Light& sky) {
    const RelativeLight colour = unit_.from_watts_per_m2(sky.intensity);
    const auto radiance = std::make_shared<SkyRadiance>(SkyDome(sky));
    if (exits().any_open) make<DomeLight>(radiance->dome(), colour, colour.sum() * area_lit(*radiance, true), exits_);
    add_exits(radiance, colour);
  }
  /// Bands of another distribution are lights of their own.
  void add_environment(const Light& environment) {
    for (const Rgb& bands : bands_of(*environment.environment)) {
      const auto band = std::make_shared<EnvironmentBand>(environment, bands);
      const RelativeLight colour = unit_.from_watts_per_m2(band->colour());
      if (colour.is_zero()) continue;
      if (exits().any_open) make<EnvironmentLight>(band, colour, colour.sum() * area_lit(*band, true), exits_);
      add_exits(band, colour);
    }
  }
  void add_exits(const std::shared_ptr<const DistantRadiance>& radiance, const RelativeLight& colour) {
    const auto count = static_cast<double>(exits().exits.size());
    const double power = colour.sum() * area_lit(*radiance, false) / std::max(1.0, count);
    for (std::size_t which = 0; which < exits_->exits.size(); ++which) make<ExitLight>(radiance, colour, power, exits_, which);
  }
  /// Returns what distant light of colour 1 sends to open or to closed faces: by as much area, m2, as it would light if it shone
  /// straight.
  double area_lit(const DistantRadiance& radiance, bool is_of_open) const {
    double sum = 0;
    for (const SkyExits::WayOut& way : ways_out_)
      if (way.is_of_open == is_of_open) sum += std::numbers::pi * way.area * radiance.smooth_radiance(way.direction);
    return sum * scene_.frame().metres_per_unit * scene_.frame().metres_per_unit;
  }

  const LocalScene& scene_;
  const EmissionUnit& unit_;
  std::uint32_t number_;
  OwnedLights lights_;
  std::shared_ptr<const SkyExits> exits_;
  std::vector<SkyExits::WayOut> ways_out_;
  std::unordered_map<const PhotometricWeb*, WebSums> sums_;
};

}  // namespace

std::vector<RelativeLight> emission_by_material(const BaseMesh& mesh, const EmissionUnit& unit) {
  std::vector<RelativeLight> emission;
  for (const Material& material : mesh.materials()) emission.push_back(unit.from_watts_per_m2(material.emission));
  return emission;
}

OwnedLights lights_of_faces(const LocalScene& scene, const EmissionUnit& unit,
                            const std::function<double(std::uint32_t root)>& cover) {
  OwnedLights lights;
  const auto emission_of = emission_by_material(scene.mesh(), unit);
  for (std::vector<std::uint32_t>& roots : lamps_of_faces(scene)) {
    std::erase_if(roots, [&](std::uint32_t root) { return cover(root) == 0; });
    if (roots.empty()) continue;
    const RelativeLight& emission = emission_of[scene.mesh().roots()[roots.front()].material];
    double there = 0;  // m2
    for (const std::uint32_t root : roots) there += cover(root) * scene.mesh().roots()[root].area;
    if (roots.size() == 1) lights.push_back(std::make_unique<FaceLight>(scene, roots[0], emission, cover(roots[0])));
    else lights.push_back(std::make_unique<MeshLight>(scene, std::move(roots), emission, there * emission.sum()));
  }
  return lights;
}

OwnedLights lights_beside_faces(const LocalScene& scene, const EmissionUnit& unit) {
  LightMaker maker(scene, unit);
  for (const Light& light : scene.mesh().lights()) light.intensity.is_zero() ? maker.skip(light) : maker.add(light);
  return maker.take();
}

}  // namespace alvor
