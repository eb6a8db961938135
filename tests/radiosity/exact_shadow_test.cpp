// Exact shadows of flat lights beside closed forms, and of the sky beside shadow rays.

#include "radiosity/direct/exact_shadow.h"

#include "radiosity/direct/direct_light.h"
#include "radiosity/direct/face_light.h"
#include "radiosity/direct/lights_of_scene.h"
#include "radiosity/form_factors/form_factor.h"
#include "tests/radiosity/solve_scenes.h"
#include "tests/radiosity/solved.h"
#include "tests/random/dice.h"
#include "tests/scenes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace alvor {
namespace {

/// Returns a floor (face 0) of 4 x 4 m at height 0 and a lamp (face 1) of 1 m2 two metres above its middle.
Scene floor_and_lamp() {
  Scene scene;
  scene.materials = {test::grey(0, 0.5), test::grey(1, 0)};
  test::add_polygon(scene, {{-2, 0, -2}, {-2, 0, 2}, {2, 0, 2}, {2, 0, -2}});
  test::add_polygon(scene, {{-0.5, 2, -0.5}, {0.5, 2, -0.5}, {0.5, 2, 0.5}, {-0.5, 2, 0.5}}, 1);
  return scene;
}

/// A root of a mesh looks at another root, past all others.
class View {
 public:
  explicit View(const Scene& scene) : mesh_(scene), local_(mesh_), tree_(local_), shadow_(tree_) {}

  bool begin(std::uint32_t patch, std::uint32_t light) {
    return shadow_.begin({local_.corners(patch), mesh_.roots()[patch].normal},
                         {local_.corners(light), mesh_.roots()[light].normal});
  }
  double visible_from(Vec3 metres) { return shadow_.visible_from(local_.frame().to_local(metres)).value(); }
  ExactShadow& shadow() { return shadow_; }

 private:
  BaseMesh mesh_;
  LocalScene local_;
  BlockerTree tree_;
  ExactShadow shadow_;
};

TEST(ExactShadow, IsClearWhereNothingStandsBetween) {
  Scene scene = floor_and_lamp();
  test::add_box(scene, {1.5, 0, 1.5}, {1.9, 0.1, 1.9}, false);                 // beside all ways from the near half of the floor
  test::add_polygon(scene, {{-3, 3, -3}, {3, 3, -3}, {3, 3, 3}, {-3, 3, 3}});  // behind the lamp
  scene.vertices[2] = {-0.5, 0, 2}, scene.vertices[3] = {-0.5, 0, -2};         // a narrow floor
  View view(scene);
  ASSERT_TRUE(view.begin(0, 1));
  EXPECT_TRUE(view.shadow().is_clear());
}

TEST(ExactShadow, OfAScreenOverHalfTheLampLeavesTheOtherHalf) {
  Scene scene = floor_and_lamp();
  test::add_polygon(scene, {{0, 1.5, -5}, {5, 1.5, -5}, {5, 1.5, 5}, {0, 1.5, 5}});
  View view(scene);
  ASSERT_TRUE(view.begin(0, 1));
  const Vec3 half[] = {{-0.5, 2, -0.5}, {0, 2, -0.5}, {0, 2, 0.5}, {-0.5, 2, 0.5}};
  EXPECT_NEAR(view.visible_from({0, 0, 0.3}), point_to_polygon({0, 0, 0.3}, {0, 1, 0}, half), 1e-12);
  EXPECT_EQ(view.visible_from({1.9, 0, 0}), 0);
}

// The second screen lies in the shadow of the first one. Its part of the shadow must not count twice.
TEST(ExactShadow, OfAScreenBehindAnotherIsNoDarker) {
  Scene one = floor_and_lamp();
  test::add_polygon(one, {{0, 1.4, -5}, {5, 1.4, -5}, {5, 1.4, 5}, {0, 1.4, 5}});
  Scene both = one;
  test::add_polygon(both, {{0.1, 1.5, -5}, {5, 1.5, -5}, {5, 1.5, 5}, {0.1, 1.5, 5}});
  View by_one(one), by_both(both);
  ASSERT_TRUE(by_one.begin(0, 1) && by_both.begin(0, 1));
  for (const double x : {-1.5, -0.5, 0.0, 0.1}) {
    EXPECT_GT(by_one.visible_from({x, 0, 0.3}), 0.01);
    EXPECT_NEAR(by_both.visible_from({x, 0, 0.3}), by_one.visible_from({x, 0, 0.3}), 1e-12);
  }
}

TEST(ExactShadow, OfTwoScreensWhoseEdgesLineUpHidesAllOfTheLamp) {
  for (const double seam : {0.0, 0.1, 0.3}) {
    Scene scene = floor_and_lamp();
    test::add_polygon(scene, {{seam, 1.5, -5}, {5, 1.5, -5}, {5, 1.5, 5}, {seam, 1.5, 5}});
    test::add_polygon(scene, {{-5, 1.4, -5}, {seam, 1.4, -5}, {seam, 1.4, 5}, {-5, 1.4, 5}});
    View view(scene);
    ASSERT_TRUE(view.begin(0, 1));
    EXPECT_EQ(view.visible_from({seam, 0, 0.3}), 0) << "straight below the line where they meet, " << seam;
    EXPECT_GT(view.visible_from({seam + 1, 0, 0.3}), 1e-4) << "between the edges, which lie at different heights";
  }
}

TEST(ExactShadow, OfASolidIsThatOfItsOutline) {
  Scene box = floor_and_lamp(), lid = floor_and_lamp();
  test::add_box(box, {-0.2, 1.0, -0.2}, {0.1, 1.3, 0.3}, false);
  test::add_polygon(lid, {{-0.2, 1.0, -0.2}, {0.1, 1.0, -0.2}, {0.1, 1.0, 0.3}, {-0.2, 1.0, 0.3}});
  View by_box(box), by_lid(lid);
  ASSERT_TRUE(by_box.begin(0, 1) && by_lid.begin(0, 1));
  // From below the middle of the box only its lower side is seen.
  EXPECT_NEAR(by_box.visible_from({-0.05, 0, 0.05}), by_lid.visible_from({-0.05, 0, 0.05}), 1e-12);
  EXPECT_LT(by_box.visible_from({1.5, 0, 0.05}), by_lid.visible_from({1.5, 0, 0.05}));  // from the side, one more
}

TEST(ExactShadow, OfWhatReachesBehindTheLampIsThatOfThePartBefore) {
  Scene through = floor_and_lamp(), before = floor_and_lamp();
  test::add_polygon(through, {{0.2, 1.5, -5}, {0.2, 1.5, 5}, {0.2, 4, 5}, {0.2, 4, -5}});
  test::add_polygon(before, {{0.2, 1.5, -5}, {0.2, 1.5, 5}, {0.2, 2, 5}, {0.2, 2, -5}});
  View first(through), second(before);
  ASSERT_TRUE(first.begin(0, 1) && second.begin(0, 1));
  EXPECT_NEAR(first.visible_from({-1, 0, 0}), second.visible_from({-1, 0, 0}), 1e-9);
}

TEST(ExactShadow, IsUnknownBehindAPaneAndBehindManyFaces) {
  Scene pane = floor_and_lamp(), blades = floor_and_lamp();
  pane.materials.push_back(test::grey(0, 0));
  pane.materials.back().regular_transmittance = {0.5, 0.5, 0.5};
  test::add_polygon(pane, {{-1, 1, -1}, {1, 1, -1}, {1, 1, 1}, {-1, 1, 1}}, 2);
  for (int n = 0; n < 20; ++n) {
    const double x = -0.5 + 0.05 * n;
    test::add_polygon(blades, {{x, 1, -1}, {x, 1, 1}, {x, 1.2, 1}, {x, 1.2, -1}});
  }
  EXPECT_FALSE(View(pane).begin(0, 1));
  EXPECT_FALSE(View(blades).begin(0, 1));
}

TEST(ExactShadow, SendsNoRays) {
  Scene scene = floor_and_lamp();
  test::add_box(scene, {-0.2, 1.0, -0.2}, {0.1, 1.3, 0.3}, false);
  const BaseMesh mesh(scene);
  const LocalScene local(mesh);
  const BlockerTree tree(local);
  RayBudget budget([] { return false; });
  const FaceLight lamp(local, 1, {1, 1, 1});
  const LightSource* const lights[]{&lamp};
  const Receiver floor{PatchId::root(0), shape_of(mesh, PatchId::root(0)), 0};
  DirectLight exact, by_rays;
  add_direct_light(local, lights, {&floor, 1}, 1, budget, {&exact, 1}, {.medium = false, .partial = false, .blockers = &tree});
  EXPECT_EQ(budget.rays(), 0u);
  EXPECT_EQ(exact.variance, 0);
  add_direct_light(local, lights, {&floor, 1}, 1, budget, {&by_rays, 1}, {.medium = false, .partial = false});
  EXPECT_NEAR(exact.irradiance.g, by_rays.irradiance.g, 5 * std::sqrt(by_rays.variance));
}

/// Returns a black room with a deep window under a clear sky, with boxes and quads in it and before the window. Face 0 is the
/// floor.
Scene furnished_room_with_deep_window(test::Dice& dice) {
  Scene scene = test::room_with_deep_window(0);
  const auto add_box = [&](double near_z, double far_z) {
    const Vec3 low{dice.between(0.2, 3), dice.between(0.1, 2), dice.between(near_z, far_z)};
    test::add_box(scene, low, low + Vec3{dice.between(0.05, 0.6), dice.between(0.05, 0.8), dice.between(0.05, 0.5)}, false);
  };
  if (dice.happens(0.5)) add_box(0.5, 3);
  if (dice.happens(0.5)) add_box(-3, -1);
  if (dice.happens(0.5)) test::add_polygon(scene, {{-9, -2, -6}, {9, -2, -6}, {9, dice.between(1, 5), -6}, {-9, 1, -6}});
  Light sky{"sky", LightKind::sky, {1, 1, 1}};
  sky.direction = {0, -1, 0};
  sky.sky = cie_sky(12, normalized(Vec3{0.5, 0.7, -0.6}));
  scene.lights = {sky};
  return scene;
}

/// Finds the direct light of the sky that sixteen patches of a room's floor receive.
struct FloorUnderASky {
  explicit FloorUnderASky(const Scene& scene)
      : mesh(scene), local(mesh), tree(local), lights(lights_beside_faces(local, EmissionUnit(mesh))) {
    for (const auto& light : lights) sources.push_back(light.get());
    for (std::uint32_t path = 0; path < 16; ++path) {
      const PatchId patch = PatchId::root(0).child(static_cast<int>(path / 4)).child(static_cast<int>(path % 4));
      receivers.push_back({patch, shape_of(mesh, patch)});
    }
  }
  std::vector<DirectLight> light_by_rays(std::uint64_t seed) const {
    RayBudget budget([] { return false; });
    std::vector<DirectLight> found(receivers.size());
    add_direct_light(local, sources, receivers, seed, budget, found, {.medium = false});
    return found;
  }
  /// Returns the light of a patch if it is found without rays.
  std::optional<DirectLight> exact_light(std::size_t r) const {
    RayBudget budget([] { return false; });
    DirectLight found;
    add_direct_light(local, sources, {&receivers[r], 1}, 1, budget, {&found, 1}, {.medium = false, .blockers = &tree});
    if (budget.rays() > 0) return std::nullopt;
    return found;
  }
  BaseMesh mesh;
  LocalScene local;
  BlockerTree tree;
  OwnedLights lights;
  std::vector<const LightSource*> sources;
  std::vector<Receiver> receivers;
};

// The rays' noise is known from their seeds; the sixteen places of a patch that are seen exactly stand for all of it, to within a
// few percent.
TEST(ExactShadow, OfTheSkyThroughADeepWindowAgreesWithRays) {
  test::Dice dice(11);
  constexpr int scenes = 60, seeds = 100;
  double sum = 0, difference = 0;
  int noiseless = 0;
  for (int n = 0; n < scenes; ++n) {
    const FloorUnderASky floor(furnished_room_with_deep_window(dice));
    std::vector<double> mean(floor.receivers.size()), squares(mean.size());
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
      const auto by_rays = floor.light_by_rays(seed);
      for (std::size_t r = 0; r < mean.size(); ++r) {
        const double irradiance = by_rays[r].irradiance.mean();
        mean[r] += irradiance / seeds, squares[r] += irradiance * irradiance / seeds;
      }
    }
    for (std::size_t r = 0; r < mean.size(); ++r) {
      const auto exact = floor.exact_light(r);
      if (!exact) continue;  // too many faces stand in the way
      ++noiseless;
      const double noise = std::sqrt(std::max(0.0, squares[r] - mean[r] * mean[r]) / seeds);
      const double off = exact->irradiance.mean() - mean[r];
      EXPECT_LT(std::abs(off), 6 * noise + 0.15 * mean[r] + 1e-6) << "scene " << n << ", patch " << r << ": " << mean[r];
      sum += mean[r], difference += off;
    }
  }
  EXPECT_GT(noiseless, scenes * 16 * 3 / 4);
  EXPECT_LT(std::abs(difference), 0.01 * sum);
}

/// Returns a room that emits all over with two books in it, black and side by side at a distance of `gap`. Face 9 is the side of
/// the first that looks at the second, beyond which it stands out by 3 cm, to z = 0.5.
constexpr double gap = 0.002, thickness = 0.028, edge = 0.47;
Scene books_in_a_furnace() {
  Scene scene;
  scene.materials = {test::grey(1, 0), test::grey(0, 0)};
  test::add_box(scene, {-1, -1, -1}, {2, 2, 2}, true);
  const std::array<std::uint32_t, 6> black{1, 1, 1, 1, 1, 1};
  test::add_box(scene, {0.4, 0.3, 0.3}, {0.42, 0.5, 0.5}, false, black);
  test::add_box(scene, {0.42 + gap, 0.3, 0.3}, {0.42 + gap + thickness, 0.5, edge}, false, black);
  return scene;
}

// A half plane that is parallel to a surface covers (1 - sin a) / 2 of its hemisphere, a being the elevation of its edge from the
// normal. Before the second book that is the edge of its far side. Four samples in a plane cannot tell this step from a slope.
TEST(Misfit, OfAStripBesideADarkGapIsFound) {
  const BaseMesh mesh(books_in_a_furnace());
  for (const std::uint64_t seed : {1, 2, 3, 4, 5}) {
    double squares = 0, area = 0;
    for (const LeafValue& leaf : test::solved(mesh, {.tolerance = 0.003, .seed = seed})) {
      if (leaf.patch.root_face() != 9) continue;
      const PatchShape shape = shape_of(mesh, leaf.patch);
      const Vec3 at = centre_of(mesh, shape);
      if (at.z < 0.4 || at.y < 0.35 || at.y > 0.45) continue;  // light comes in at the other edges of the gap, too
      const double d = at.z - edge, height = d < 0 ? gap : gap + thickness;
      const double expected = (1 + d / std::sqrt(d * d + height * height)) / 2;
      squares += area_of(mesh, shape) * std::pow(leaf.irradiance.g - expected, 2);
      area += area_of(mesh, shape);
    }
    EXPECT_LT(std::sqrt(squares / area), 0.12) << "seed " << seed;
  }
}

}  // namespace
}  // namespace alvor
