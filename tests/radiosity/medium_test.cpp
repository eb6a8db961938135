// Light that fades on its way, against independent Monte Carlo and closed forms.

#include "meshing/patch_place.h"
#include "tests/radiosity/solved.h"
#include "tests/scenes.h"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

namespace alvor {
namespace {

/// The mean irradiance over the area, and the irradiance of the leaf whose centre is nearest to a point, W/m2.
struct Solved {
  Solved(const Scene& scene, const SolveOptions& options) : mesh(scene), leaves(test::solved(mesh, options)) {}
  Rgb mean() const {
    Rgb sum;
    double area = 0;
    for (const LeafValue& leaf : leaves) {
      const double a = area_of(mesh, shape_of(mesh, leaf.patch));
      sum += a * widen(leaf.irradiance);
      area += a;
    }
    return sum * (1 / area);
  }
  BaseMesh mesh;
  std::vector<LeafValue> leaves;
};

/// Returns the mean of exp(-a r) along cosine-distributed rays from the walls of a 3 x 2 x 4 m room. It is H / E if nothing
/// reflects.
double mean_transmittance(double absorption, int rays) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform;
  const std::array<double, 3> size{3, 2, 4};
  const std::array<double, 3> face_area{size[1] * size[2], size[0] * size[2], size[0] * size[1]};
  double sum = 0;
  for (int n = 0; n < rays; ++n) {
    double pick = uniform(random) * (face_area[0] + face_area[1] + face_area[2]);
    int axis = 0;
    while (axis < 2 && pick > face_area[static_cast<std::size_t>(axis)]) pick -= face_area[static_cast<std::size_t>(axis++)];
    const double rr = uniform(random), phi = 2 * std::numbers::pi * uniform(random);
    std::array<double, 3> at{}, along{};
    at[axis] = 0, along[axis] = std::sqrt(1 - rr);
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    at[u] = size[u] * uniform(random), along[u] = std::sqrt(rr) * std::cos(phi);
    at[v] = size[v] * uniform(random), along[v] = std::sqrt(rr) * std::sin(phi);
    double distance = 1e300;
    for (int d = 0; d < 3; ++d)
      if (along[d] != 0) distance = std::min(distance, (along[d] > 0 ? size[d] - at[d] : -at[d]) / along[d]);
    sum += std::exp(-absorption * distance);
  }
  return sum / rays;
}

TEST(Medium, BlackFurnaceReceivesWhatTheMediumLetsThrough) {
  Scene scene = test::furnace(1, 0);
  scene.absorption = {0, 0.3, 2};
  const Rgb mean = Solved(scene, {.tolerance = 0.003}).mean();
  EXPECT_NEAR(mean.r, 1, 1e-5);
  constexpr int rays = 1'000'000;
  // The standard error of the test's own estimate is below 0.3 / sqrt(rays) = 3e-4; that of the rows is smaller.
  EXPECT_NEAR(mean.g, mean_transmittance(0.3, rays), 1.5e-3);
  EXPECT_NEAR(mean.b, mean_transmittance(2, rays), 1.5e-3);
}

TEST(Medium, SmallFarLampIsDimmedByTheDistance) {
  Scene scene;
  scene.materials = {test::grey(0, 0), test::grey(1000, 0)};
  test::add_polygon(scene, {{-0.05, 0, 0.05}, {0.05, 0, 0.05}, {0.05, 0, -0.05}, {-0.05, 0, -0.05}});
  test::add_polygon(scene, {{-0.05, 5, -0.05}, {0.05, 5, -0.05}, {0.05, 5, 0.05}, {-0.05, 5, 0.05}}, 1);
  const Rgb clear = widen(Solved(scene, {.max_depth = 0}).leaves.at(0).irradiance);
  scene.absorption = {0.1, 0.5, 1};
  const Rgb dimmed = widen(Solved(scene, {.max_depth = 0}).leaves.at(0).irradiance);
  ASSERT_GT(clear.r, 0);
  // Distances differ from 5 m by less than 1e-3 m.
  EXPECT_NEAR(dimmed.r / clear.r, std::exp(-0.5), 1e-3);
  EXPECT_NEAR(dimmed.g / clear.g, std::exp(-2.5), 1e-3);
  EXPECT_NEAR(dimmed.b / clear.b, std::exp(-5.0), 1e-3);
}

TEST(Medium, LengthsAndAbsorptionScaleAgainstEachOther) {
  Scene scene = test::furnace(1, 0.5);
  scene.absorption = {0.1, 0.2, 0.4};
  const Rgb metres = Solved(scene, {.max_depth = 3}).mean();
  for (Vec3& vertex : scene.vertices) vertex = 1000 * vertex;
  scene.absorption *= 1e-3;
  const Rgb kilometres = Solved(scene, {.max_depth = 3}).mean();
  EXPECT_NEAR(metres.g, kilometres.g, 1e-4 * metres.g);
}

// If the transmittance t were the same everywhere, x = 1 / (1 - rho t) per band. It is not, but more absorption never brings more
// light.
TEST(Medium, MoreAbsorptionBringsLessLight) {
  Scene scene = test::furnace(1, 0.8);
  scene.absorption = {0, 0.05, 0.5};
  const Rgb mean = Solved(scene, {.max_depth = 2}).mean();
  EXPECT_NEAR(mean.r, 5, 1e-3);
  EXPECT_LT(mean.g, mean.r);
  EXPECT_LT(mean.b, mean.g);
  EXPECT_GT(mean.b, 0);
}

}  // namespace
}  // namespace alvor
