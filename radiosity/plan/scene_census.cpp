#include "radiosity/plan/scene_census.h"

#include <algorithm>
#include <vector>

namespace alvor {

namespace {

bool is_grey(const Material& material) {
  return material.emission.is_grey() && material.reflectance.is_grey() && material.regular_transmittance.is_grey();
}

bool is_grey(const Light& light) {
  const auto is_grey_pixel = [](const RgbF& pixel) { return widen(pixel).is_grey(); };
  return light.intensity.is_grey() && (!light.environment || std::ranges::all_of(light.environment->pixels, is_grey_pixel));
}

}  // namespace

SceneCensus::SceneCensus(const BaseMesh& mesh) {
  std::vector<bool> is_used(mesh.materials().size());
  double area = 0, emitting_area = 0;
  for (const RootPatch& root : mesh.roots()) {
    const Material& material = mesh.materials()[root.material];
    const bool emits = !material.emission.is_zero();
    is_used[root.material] = true;
    area += root.area;
    if (emits) emitting_area += root.area;
    if (root.is_back) continue;
    ++faces;
    emitting_faces += emits;
    panes += material.is_pane();
    two_sided_faces += root.twin != RootPatch::no_twin;
  }
  for (const Light& light : mesh.lights()) {
    if (light.intensity.is_zero()) continue;
    ++lights;
    has_distant_light |= light.is_distant();
    if (!coloured_light && !is_grey(light)) coloured_light = &light;
  }
  emitting_share = area > 0 ? emitting_area / area : 0;
  for (std::size_t m = 0; m < is_used.size(); ++m) {
    if (!is_used[m]) continue;
    const Material& material = mesh.materials()[m];
    ++materials;
    reflecting_materials += !material.reflectance.is_zero();
    grey_materials += is_grey(material);
    if (!is_grey(material) && !coloured) coloured = &material;
    largest_reflectance = std::max(largest_reflectance, material.reflectance.max());
  }
}

}  // namespace alvor
