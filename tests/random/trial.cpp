#include "tests/random/trial.h"

#include "tests/random/dice.h"
#include "tests/random/random_faces.h"
#include "tests/random/random_flaws.h"

#include <algorithm>

namespace alvor::test {

namespace {

constexpr double longest_solve_s = 10;  // far more than such a scene takes, even under sanitizers; a solve that it ends has hung

Rgb random_bands(Dice& dice, double low, double high) {
  const double grey = dice.between(low, high);
  if (dice.happens(0.4)) return {grey, grey, grey};
  Rgb bands{dice.between(low, high), dice.between(low, high), dice.between(low, high)};
  if (dice.happens(0.2)) bands.g = 0;
  if (dice.happens(0.2)) bands.r = bands.b = 0;
  return bands;
}

Rgb random_reflectance(Dice& dice) {
  switch (dice.below(8)) {
    case 0: return {};
    case 1: return {0.999999, 0.999999, 0.999999};
    case 2: return {0.999999, 0, 0.01};
    case 3: return random_bands(dice, 0.9, 0.999);
    default: return random_bands(dice, 0, 0.9);
  }
}

Material random_material(Dice& dice, bool emits, bool any_magnitude) {
  Material material{"m", {}, random_reflectance(dice), dice.happens(0.3)};
  if (emits)
    material.emission = (any_magnitude ? dice.magnitude(1e-30, 1e30) : dice.magnitude(1, 100)) * random_bands(dice, 0, 1);
  return material;
}

std::vector<Material> random_materials(Dice& dice, std::size_t count) {
  const bool any_magnitude = dice.happens(0.2);
  const double emitting = dice.one_of({0.1, 0.3, 1.0});
  std::vector<Material> materials;
  for (std::size_t m = 0; m < count; ++m) {
    materials.push_back(random_material(dice, m == 0 || dice.happens(emitting), any_magnitude));
    materials.back().name += std::to_string(m);
  }
  if (dice.happens(0.15))  // a closed room of these is nearly a furnace
    for (Material& material : materials) material.reflectance = materials[0].reflectance;
  for (Material& material : materials)
    if (dice.happens(0.15)) material.regular_transmittance = random_bands(dice, 0, 1) * (Rgb{1, 1, 1} - material.reflectance);
  return materials;
}

// Returns random options. Exact form factors look at all pairs, and classical strategies take 1 / (1 - reflectance) rounds, so
// both are used only where they end soon.
SolveOptions random_options(Dice& dice, const Scene& scene) {
  SolveOptions options;
  options.tolerance = dice.one_of({1e-9, 0.01, 0.05, 0.2});
  options.max_depth = static_cast<int>(dice.below(5));
  options.max_leaves = scene.faces.size() + dice.below(dice.happens(0.05) ? 1000 : 150);
  if (dice.happens(0.1)) options.min_edge_m = dice.magnitude(1e-3, 1);
  options.time_limit_s = longest_solve_s;
  options.threads = 1 + static_cast<int>(dice.below(2));
  options.seed = dice.bits();
  options.form_factors = dice.one_of({FormFactorMethod::automatic, FormFactorMethod::nusselt, FormFactorMethod::hemicube});
  if (scene.faces.size() <= 8 && dice.happens(0.15)) {
    options.form_factors = FormFactorMethod::analytic;
    options.max_leaves = std::min<std::uint64_t>(options.max_leaves, 60);
  }
  double most = 0;
  for (const Material& material : scene.materials)
    most = std::max(most, (material.reflectance + material.diffuse_transmittance).max());
  if (most < 0.95)
    options.strategy = dice.one_of({Strategy::automatic, Strategy::automatic, Strategy::sorted, Strategy::sorted_ambient,
                                    Strategy::gather, Strategy::shoot, Strategy::overshoot});
  return options;
}

/// Scales and moves the scene to a random size and place.
void move(Dice& dice, Scene& scene) {
  const double size = dice.happens(0.5) ? 1 : dice.magnitude(1e-6, 1e6);
  const double away = dice.happens(0.7) ? 0 : dice.magnitude(1, 400);  // in sizes
  const Vec3 offset = (size * away) * Vec3{dice.between(-1, 1), dice.between(-1, 1), dice.between(-1, 1)};
  for (Vec3& vertex : scene.vertices) vertex = size * vertex + offset;
  scene.absorption = (1 / size) * scene.absorption;
}

void add_colours(Dice& dice, Scene& scene) {
  const bool is_grey = dice.happens(0.3);
  for (std::size_t corner = 0; corner < scene.corners.size(); ++corner) {
    const auto value = [&] { return static_cast<float>(dice.between(0, 1)); };
    const float grey = value();
    scene.corner_colours.push_back(is_grey ? RgbF{grey, grey, grey} : RgbF{grey, value(), value()});
  }
}

/// Lays random images on some materials, anyhow.
void add_textures(Dice& dice, Scene& scene) {
  for (Material& material : scene.materials) {
    if (material.is_pane() || !dice.happens(0.3)) continue;
    ColourImage image{1 + dice.below(9), 1 + dice.below(9), {}};
    const bool is_grey = dice.happens(0.3);
    for (std::size_t texel = 0; texel < image.texel_count(); ++texel) {
      const auto value = [&] { return static_cast<std::uint8_t>(dice.below(240)); };
      const std::uint8_t red = value(), green = is_grey ? red : value(), blue = is_grey ? red : value();
      image.texels.insert(image.texels.end(), {red, green, blue});
    }
    const Rgb factor = random_bands(dice, 0, 1);
    material.reflectance = factor * mean_surface(image).reflectance;
    material.texture = Texture{std::make_shared<const ColourImage>(std::move(image)), factor,
                               dice.one_of({Wrap::repeat, Wrap::mirror, Wrap::clamp}), Wrap::repeat};
  }
  const auto far = static_cast<float>(dice.one_of({0.3, 2.0, 50.0}));
  const auto place = [&] { return static_cast<float>(dice.between(-1, 1)) * far; };
  for (std::size_t corner = 0; corner < scene.corners.size(); ++corner) scene.texture_points.push_back({place(), place()});
}

/// Cuts holes into some of the images, and makes some materials translucent.
void add_holes_and_translucence(Dice& dice, Scene& scene) {
  for (Material& material : scene.materials) {
    if (material.texture && dice.happens(0.5)) {
      ColourImage image{material.texture->image->columns, material.texture->image->rows, {}, true};
      for (std::size_t i = 0; i < material.texture->image->texels.size(); ++i) {
        image.texels.push_back(material.texture->image->texels[i]);
        if (i % 3 == 2)
          image.texels.push_back(dice.happens(0.6) ? (dice.happens(0.5) ? 0 : 255) : static_cast<std::uint8_t>(dice.below(256)));
      }
      material.reflectance = material.texture->factor * mean_surface(image).reflectance;
      material.texture->image = std::make_shared<const ColourImage>(std::move(image));
    }
    if (!dice.happens(0.4)) continue;
    const Rgb left =
        Rgb{0.999, 0.999, 0.999} - material.regular_transmittance - upper(material.reflectance, material.largest_reflectance());
    material.diffuse_transmittance = random_bands(dice, 0, 1) * upper(left, Rgb{});
    material.two_sided |= material.is_translucent();
  }
}

}  // namespace

Trial random_trial(std::uint64_t seed) {
  Dice dice(seed);
  Trial trial;
  trial.seed = seed;
  trial.scene.materials = random_materials(dice, 1 + dice.below(5));
  if (dice.happens(0.15)) trial.scene.absorption = dice.magnitude(0.01, 10) * random_bands(dice, 0, 1);
  add_random_faces(dice, trial.scene);
  if (dice.happens(0.5)) trial.is_well_posed = add_flaws(dice, trial.scene);
  move(dice, trial.scene);
  if (dice.happens(0.2)) add_textures(dice, trial.scene);
  Dice of_colours(~seed);  // of its own, so that a seed stands for the same scene as before there were colours
  if (of_colours.happens(0.1)) add_colours(of_colours, trial.scene);
  Dice of_sheets(seed ^ 0x5bd1e995u);  // of its own, likewise
  if (of_sheets.happens(0.2)) add_holes_and_translucence(of_sheets, trial.scene);
  if (dice.happens(0.03)) trial.faulty_place = add_fault(dice, trial.scene);
  trial.options = random_options(dice, trial.scene);
  return trial;
}

Solved solved(const BaseMesh& mesh, const SolveOptions& options) {
  SolutionLog log;
  const SolveOutcome outcome = solve(mesh, options, log, {});
  return {outcome, log.leaves(), log.steps()};
}

}  // namespace alvor::test
