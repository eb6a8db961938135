#include "radiosity/plan/scene_census.h"

#include <algorithm>
#include <span>
#include <unordered_map>
#include <vector>

namespace alvor {

namespace {

bool is_grey(const ColourImage& image) {
  for (std::size_t i = 0; i < image.texels.size(); i += image.bytes_a_texel())
    if (image.texels[i] != image.texels[i + 1] || image.texels[i] != image.texels[i + 2]) return false;
  return true;
}

/// Tells which materials are grey. Looks at each image once, however many materials share it.
class GreyMaterials {
 public:
  bool contain(const Material& material) {
    return material.emission.is_grey() && material.reflectance.is_grey() && material.regular_transmittance.is_grey() &&
           material.diffuse_transmittance.is_grey() &&
           (!material.texture || (material.texture->factor.is_grey() && contain(*material.texture->image)));
  }

 private:
  bool contain(const ColourImage& image) {
    const auto [found, is_new] = images_.try_emplace(&image);
    if (is_new) found->second = is_grey(image);
    return found->second;
  }
  std::unordered_map<const ColourImage*, bool> images_;
};

bool is_grey(const Light& light) {
  const auto is_grey_pixel = [](const RgbF& pixel) { return widen(pixel).is_grey(); };
  return light.intensity.is_grey() && (!light.environment || std::ranges::all_of(light.environment->pixels, is_grey_pixel));
}

/// Returns whether the corners of a root have colours that are not grey.
bool is_coloured(const BaseMesh& mesh, std::uint32_t root) {
  if (!mesh.has_colours()) return false;
  const auto corners = static_cast<std::size_t>(mesh.roots()[root].corner_count);
  return !std::ranges::all_of(std::span(mesh.corner_colours(root)).first(corners), &RgbF::is_grey);
}

}  // namespace

SceneCensus::SceneCensus(const BaseMesh& mesh) {
  std::vector<bool> is_used(mesh.materials().size()), has_colours(mesh.materials().size());
  double area = 0, emitting_area = 0;
  for (std::uint32_t r = 0; r < mesh.roots().size(); ++r) {
    const RootPatch& root = mesh.roots()[r];
    if (root.is_hidden) continue;
    const Material& material = mesh.materials()[root.material];
    if (is_coloured(mesh, r)) has_colours[root.material] = true;
    const bool emits = !material.emission.is_zero();
    is_used[root.material] = true;
    area += root.area;
    if (emits) emitting_area += root.area;
    if (root.is_back) continue;
    ++faces;
    emitting_faces += emits;
    has_cut_emitter |= emits && material.has_cutout();
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
  GreyMaterials grey;
  for (std::size_t m = 0; m < is_used.size(); ++m) {
    if (!is_used[m]) continue;
    const Material& material = mesh.materials()[m];
    ++materials;
    reflecting_materials += !material.reflectance.is_zero() || material.is_translucent();
    const bool is_grey = !has_colours[m] && grey.contain(material);
    grey_materials += is_grey;
    if (!is_grey && !coloured) coloured = &material;
    largest_reflectance = std::max(largest_reflectance, material.largest_albedo().max());
  }
}

}  // namespace alvor
