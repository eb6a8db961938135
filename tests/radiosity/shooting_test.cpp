#include "radiosity/shooting.h"

#include <gtest/gtest.h>

#include <random>

namespace alvor {
namespace {

/// A random closed system: each patch of one to three leaves, each row of 64 hits.
struct System {
  std::vector<TransportRow> rows;
  std::vector<ShootingPatch> patches;
  std::vector<ShootingLeaf> leaves;
  std::vector<std::uint32_t> hit_leaf;

  explicit System(unsigned seed, std::uint32_t count = 20) : rows(count) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(0.1, 0.9);
    for (std::uint32_t p = 0; p < count; ++p) {
      rows[p].hits.resize(64);
      rows[p].first_half_hits = rows[p].first_half_rays = rows[p].second_half_rays = 32;
      ShootingPatch patch{&rows[p], std::uint32_t(leaves.size()), 1 + std::uint32_t(random() % 3), {}, 0};
      patch.reflectance = {uniform(random), uniform(random), uniform(random)};
      for (std::uint32_t k = 0; k < patch.leaf_count; ++k) {
        leaves.push_back({uniform(random), {uniform(random), 0, uniform(random)}, {}});
        patch.area += leaves.back().area;
      }
      patches.push_back(patch);
    }
    for (std::size_t h = 0; h < 64u * count; ++h) hit_leaf.push_back(std::uint32_t(random() % leaves.size()));
  }

  /// x = e + rho F x by many Jacobi iterations.
  std::vector<Rgb> solved() const {
    std::vector<Rgb> x(leaves.size());
    for (int n = 0; n < 2000; ++n) {
      std::vector<Rgb> next(leaves.size());
      for (std::size_t p = 0; p < patches.size(); ++p) {
        Rgb sum;
        for (std::size_t h = 0; h < 64; ++h) sum += x[hit_leaf[64 * p + h]];
        for (std::uint32_t k = 0; k < patches[p].leaf_count; ++k) {
          const std::size_t leaf = patches[p].first_leaf + k;
          next[leaf] = leaves[leaf].unshot + patches[p].reflectance * (sum * (1.0 / 64));
        }
      }
      x = next;
    }
    return x;
  }
};

void expect_near(std::span<const Rgb> got, std::span<const Rgb> expected, double relative) {
  ASSERT_EQ(got.size(), expected.size());
  for (std::size_t n = 0; n < got.size(); ++n) {
    EXPECT_NEAR(got[n].r, expected[n].r, relative * expected[n].r);
    EXPECT_NEAR(got[n].g, expected[n].g, relative * expected[n].g + 1e-300);
    EXPECT_NEAR(got[n].b, expected[n].b, relative * expected[n].b);
  }
}

void shoot_all(Shooting& shooting) {
  const double start = shooting.unshot_power();
  while (shooting.unshot_power() > 1e-12 * start) shooting.sweep();
}

TEST(Shooting, ConvergesToTheSolutionOfTheRows) {
  for (unsigned seed = 0; seed < 5; ++seed) {
    const System system(seed);
    Shooting shooting(system.patches, system.leaves, system.hit_leaf);
    shooting.gather();
    shooting.reflect_gathered();
    shoot_all(shooting);
    expect_near(shooting.shot(), system.solved(), 1e-9);
  }
}

TEST(Shooting, GoesOnFromAnyStateBecauseUnshotIsTheResidual) {
  const System system(7);
  System started = system;
  std::mt19937 random(1);
  for (ShootingLeaf& leaf : started.leaves) {  // more was "shot" in some places than is right: negative residuals follow
    leaf.shot = double(random() % 10) * Rgb{1, 0, 1};
    leaf.unshot -= leaf.shot;
  }
  Shooting shooting(started.patches, started.leaves, started.hit_leaf);
  shooting.gather();
  shooting.reflect_gathered();
  shoot_all(shooting);
  expect_near(shooting.shot(), system.solved(), 1e-9);
}

TEST(Shooting, IrradianceIsTheRowsTimesWhatWasShot) {
  const System system(3);
  Shooting shooting(system.patches, system.leaves, system.hit_leaf);
  shooting.gather();
  shooting.reflect_gathered();
  for (int n = 0; n < 5; ++n) shooting.sweep();
  const auto shot = shooting.shot();
  for (std::size_t p = 0; p < system.patches.size(); ++p) {
    Rgb sum;
    for (std::size_t h = 0; h < 64; ++h) sum += shot[system.hit_leaf[64 * p + h]];
    EXPECT_NEAR(shooting.irradiance()[p].r, sum.r / 64, 1e-12);
  }
}

TEST(Shooting, AmbientTermBalancesTheEnergyOfAUniformEnclosure) {
  // Uniform rho and equal areas: sum A (B + rho ambient) = sum A E / (1 - rho) after every shot, if rows are symmetric. Here
  // every patch sees every leaf once, so they are.
  constexpr std::uint32_t count = 16;
  std::vector<TransportRow> rows(count);
  std::vector<ShootingPatch> patches;
  std::vector<ShootingLeaf> leaves;
  std::vector<std::uint32_t> hit_leaf;
  for (std::uint32_t p = 0; p < count; ++p) {
    rows[p].hits.resize(count);
    rows[p].first_half_hits = rows[p].first_half_rays = rows[p].second_half_rays = count / 2;
    patches.push_back({&rows[p], p, 1, {0.8, 0.8, 0.8}, 1});
    leaves.push_back({1, p == 0 ? Rgb{1, 1, 1} : Rgb{}, {}});
    for (std::uint32_t h = 0; h < count; ++h) hit_leaf.push_back(h);
  }
  Shooting shooting(patches, leaves, hit_leaf);
  shooting.gather();
  shooting.reflect_gathered();
  for (int n = 0; n < 10; ++n) {
    double sum = 0;
    for (std::uint32_t p = 0; p < count; ++p)
      sum += (p == 0 ? 1 : 0) + 0.8 * (shooting.irradiance()[p].g + shooting.ambient_irradiance().g);
    EXPECT_NEAR(sum, 1 / (1 - 0.8), 1e-9) << "after " << n << " sweeps";
    shooting.sweep();
  }
}

}  // namespace
}  // namespace alvor
