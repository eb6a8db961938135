// A feature that the plan switches off is forced on: the answer stays, and takes more work.

#include "radiosity/solver.h"
#include "tests/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace alvor {
namespace {

struct Solved {
  std::vector<LeafValue> leaves;  ///< in the order of ids
  std::uint64_t rays = 0;
};

Solved solved(const Scene& scene, const SolveOptions& options) {
  const BaseMesh mesh(scene);
  SolutionLog log;
  solve(mesh, options, log, {});
  Solved all{log.leaves(), log.last_step().rays};
  std::ranges::sort(all.leaves, {}, &LeafValue::patch);
  return all;
}

struct Pair {
  Solved as_planned, forced;
  /// Largest difference of irradiance, of the largest irradiance; 1 if the meshes differ.
  double difference() const {
    if (!std::ranges::equal(as_planned.leaves, forced.leaves, {}, &LeafValue::patch, &LeafValue::patch)) return 1;
    double largest = 0, difference = 0;
    for (std::size_t n = 0; n < forced.leaves.size(); ++n) {
      const RgbF &a = as_planned.leaves[n].irradiance, &b = forced.leaves[n].irradiance;
      largest = std::max<double>(largest, b.max());
      difference = std::max<double>(difference, absolute(a - b).max());
    }
    return difference / largest;
  }
};

/// Fails unless the plan switches the feature off.
Pair solved_both_ways(const Scene& scene, Feature feature, SolveOptions options = {}) {
  options.threads = 1;
  EXPECT_FALSE(Plan(BaseMesh(scene), options).needs(feature)) << text(feature);
  Pair pair;
  pair.as_planned = solved(scene, options);
  options.forced_on.add(feature);
  pair.forced = solved(scene, options);
  return pair;
}

/// An empty room whose ceiling is a lamp.
Scene convex_room() {
  Scene scene;
  scene.materials = {test::grey(0, 0.6), test::grey(10, 0.2)};
  test::add_box(scene, {0, 0, 0}, {4, 3, 5}, true, {0, 1, 0, 0, 0, 0});
  return scene;
}

constexpr double rounding = 1e-5;  // of float32, along some ten reflections

TEST(SwitchedOff, OcclusionInAConvexRoomSavesAllShadowRays) {
  const Pair pair = solved_both_ways(convex_room(), Feature::occlusion);
  EXPECT_LT(pair.difference(), rounding);
  EXPECT_LT(pair.as_planned.rays, pair.forced.rays);
}

TEST(SwitchedOff, OcclusionInAConvexRoomFullOfFogSavesAllShadowRays) {
  Scene scene = convex_room();
  scene.absorption = {0.1, 0.2, 0.3};
  const Pair pair = solved_both_ways(scene, Feature::occlusion, {.max_leaves = 2000});
  EXPECT_LT(pair.difference(), rounding);
  EXPECT_LT(pair.as_planned.rays, pair.forced.rays);
}

TEST(SwitchedOff, OcclusionUnderManyLampsSavesAllShadowRays) {
  Scene scene;
  scene.materials = {test::grey(0, 0.6), test::grey(10, 0)};
  test::add_box(scene, {0, 0, 0}, {8, 3, 8}, true);
  scene.faces.erase(scene.faces.begin() + 1);  // the ceiling is tiles, every other one a lamp
  for (int x = 0; x < 6; ++x)
    for (int z = 0; z < 6; ++z) {
      const double a = x * 8 / 6.0, c = z * 8 / 6.0, b = (x + 1) * 8 / 6.0, d = (z + 1) * 8 / 6.0;
      test::add_polygon(scene, {{a, 3, c}, {b, 3, c}, {b, 3, d}, {a, 3, d}}, static_cast<std::uint32_t>((x + z) % 2));
    }
  const Pair pair = solved_both_ways(scene, Feature::occlusion, {.tolerance = 0.1, .max_leaves = 2000});
  EXPECT_LT(pair.difference(), rounding);
  EXPECT_LT(pair.as_planned.rays, pair.forced.rays);
}

}  // namespace
}  // namespace alvor
