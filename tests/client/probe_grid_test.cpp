// Tests of light in the air: spherical harmonics at the places of a grid.

#include "client/bake/probe_grid.h"
#include "client/verify/probe.h"
#include "radiosity/solve/solver.h"
#include "tests/scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace alvor {
namespace {

using nlohmann::json;

DisplayMesh solved(const Scene& scene) {
  const BaseMesh mesh(scene);
  SolutionLog log;
  solve(mesh, {.tolerance = 0.03}, log, {});
  return build_display_mesh(mesh, log.leaves());
}

TEST(AirProbes, HarmonicsAreOrthonormal) {
  // Gauss's rule is not needed: a fine grid over the sphere is exact enough.
  std::array<std::array<double, 9>, 9> product{};
  constexpr int rows = 200, columns = 400;
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c) {
      const double z = 2 * (r + 0.5) / rows - 1, angle = 2 * std::numbers::pi * c / columns, wide = std::sqrt(1 - z * z);
      const auto values = spherical_harmonics({wide * std::cos(angle), wide * std::sin(angle), z});
      for (std::size_t i = 0; i < 9; ++i)
        for (std::size_t j = 0; j < 9; ++j) product[i][j] += values[i] * values[j] * 4 * std::numbers::pi / (rows * columns);
    }
  for (std::size_t i = 0; i < 9; ++i)
    for (std::size_t j = 0; j < 9; ++j) EXPECT_NEAR(product[i][j], i == j, 1e-3) << i << " " << j;
}

TEST(AirProbes, InEvenLightAreTheSameInAllDirections) {
  // Every surface leaves B = E / (1 - rho), and that is the irradiance of all there is.
  const DisplayMesh solution = solved(test::furnace(2, 0.5));
  for (const AirProbe& probe : probe_grid(solution, {2, 2, 2})) {
    ASSERT_FALSE(probe.is_enclosed);
    for (const Vec3& normal : {Vec3{1, 0, 0}, Vec3{0, -1, 0}, Vec3{0.6, 0, 0.8}})
      EXPECT_NEAR(probe.irradiance_along(normal).g, 4, 0.04);
  }
}

TEST(AirProbes, TurnedUprightTellTheSameLightInTheTurnedDirection) {
  AirProbe probe{{1, 2, 3}, {}, false};
  for (std::size_t k = 0; k < 9; ++k) probe.irradiance[k] = Rgb{1, 1, 1} * std::sin(1.0 + static_cast<double>(k));
  const AirProbe turned = turned_upright({probe}, UpAxis::z).front();
  EXPECT_EQ(turned.at, (Vec3{1, 3, -2}));
  for (const Vec3& n : {Vec3{0, 0, 1}, Vec3{0, 1, 0}, normalized(Vec3{1, 2, -3}), normalized(Vec3{-2, 0.3, 1})})
    EXPECT_NEAR(turned.irradiance_along({n.x, n.z, -n.y}).g, probe.irradiance_along(n).g, 1e-12);
  EXPECT_EQ(turned_upright({probe}, UpAxis::y).front().irradiance_along({0, 0, 1}), probe.irradiance_along({0, 0, 1}));
}

TEST(AirProbes, TellWhatAMeterInTheAirWouldRead) {
  Scene scene;
  scene.materials = {test::grey(0, 0.5), test::grey(10, 0)};
  test::add_box(scene, {0, 0, 0}, {3, 2, 4}, true, {0, 0, 0, 1, 0, 0});
  test::add_box(scene, {1, 0.5, 1}, {2, 1.5, 3}, false);
  const DisplayMesh solution = solved(scene);
  const auto probes = probe_grid(solution, {3, 1, 2});
  ASSERT_EQ(probes.size(), 6u);
  EXPECT_TRUE(probes[1].is_enclosed);  // in the box
  EXPECT_FALSE(probes[0].is_enclosed);
  for (const Vec3& normal : {Vec3{0, 1, 0}, normalized(Vec3{1, 1, 1}), Vec3{0, -1, 0}, normalized(Vec3{-1, 0.5, 0.2})}) {
    const auto meter = probe(solution, std::array{ProbePoint{probes[0].at, normal}});
    EXPECT_NEAR(probes[0].irradiance_along(normal).mean(), widen(meter[0].irradiance).mean(),
                0.06 * probes[0].irradiance[0].mean());
  }
  const json said = probes_json(probes, {3, 1, 2}, solution.quantity);
  EXPECT_TRUE(said["probes"][1]["irradiance"].is_null());
  EXPECT_EQ(said["probes"][0]["irradiance"].size(), 9u);
}

}  // namespace
}  // namespace alvor
