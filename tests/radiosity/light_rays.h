#pragma once
// Compares the shadow rays of a light with its formula.

#include "radiosity/direct/light_source.h"
#include "radiosity/rays/local_scene.h"
#include "radiosity/rays/sampling.h"

#include <gtest/gtest.h>

namespace alvor::test {

/// Expects that at points of root 0 the mean weight of `rounds` rays to the light is its unblocked irradiance, to the share
/// `tolerance`.
inline void expect_rays_match_formula(const LocalScene& scene, const LightSource& light, std::uint32_t rounds, double tolerance) {
  const PatchId floor = PatchId::root(0);
  RandomStream random(1, floor);
  const PatchPoints points = sample_points(scene, shape_of(scene.mesh(), floor), random);
  RayPacket rays;
  std::array<float, RayPacket::width> weights;
  std::array<double, RayPacket::width> mean{};
  ShadowAim aim{points, scene.root(0).normal, {}, rays, weights};
  for (std::uint32_t n = 0; n < rounds; ++n) {
    aim.at.fill(sobol_point(n, 0, 0));
    light.aim(aim, 0, RayPacket::width);
    for (std::size_t o = 0; o < mean.size(); ++o) mean[o] += weights[o] / double(rounds);
  }
  for (std::size_t o = 0; o < mean.size(); ++o) {
    const double formula = light.unblocked({points.x[o], points.y[o], points.z[o]}, scene.mesh().roots()[0].normal);
    EXPECT_NEAR(light.sample_scale(1) * mean[o], formula, tolerance * formula + 1e-9) << "light " << light.number();
    EXPECT_NEAR(light.sample_scale(0.25) * mean[o], 4 * formula, 4 * tolerance * formula + 1e-9) << "light " << light.number();
  }
}

/// Returns the share of rays that count where `rounds` rays go from each origin of the first face: (sum of weights)^2 over their
/// number and the sum of squares, which is 1 if all bring the same; mean over origins.
inline double rays_that_count(const LocalScene& scene, const LightSource& light, std::uint32_t rounds) {
  const PatchId floor = PatchId::root(0);
  RandomStream random(1, floor);
  const PatchPoints points = sample_points(scene, shape_of(scene.mesh(), floor), random);
  RayPacket rays;
  std::array<float, RayPacket::width> weights;
  std::array<double, RayPacket::width> sum{}, squares{};
  ShadowAim aim{points, scene.root(0).normal, {}, rays, weights};
  for (std::uint32_t n = 0; n < rounds; ++n) {
    aim.at.fill(sobol_point(n, 0, 0));
    light.aim(aim, 0, RayPacket::width);
    for (std::size_t o = 0; o < sum.size(); ++o) sum[o] += weights[o], squares[o] += weights[o] * weights[o];
  }
  double share = 0;
  for (std::size_t o = 0; o < sum.size(); ++o) share += sum[o] * sum[o] / (rounds * squares[o]) / RayPacket::width;
  return share;
}

}  // namespace alvor::test
