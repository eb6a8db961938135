#include "radiosity/rays/direction_guide.h"
#include "radiosity/rays/unit_disk.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

namespace alvor {
namespace {

constexpr std::uint32_t grid = 512;

/// Calls `body` with the middles of a grid of points in the unit square.
void for_each_point(const std::function<void(Uv)>& body) {
  for (std::uint32_t i = 0; i < grid; ++i)
    for (std::uint32_t j = 0; j < grid; ++j) body({(i + 0.5) / grid, (j + 0.5) / grid});
}

Vec3 cosine_distributed(Uv at) {
  const DiskPoint d = concentric_disk(at);
  return {d.x, d.y, std::sqrt(std::max(0.0, 1 - d.x * d.x - d.y * d.y))};
}

/// Light of a small bright source, low over the horizon, before dim surroundings.
double beacon(Vec3 direction) { return dot(direction, normalized({3, 1, 1})) > 0.995 ? 40 : 0.2 + 0.1 * direction.x; }

DirectionGuide guide_of(double (*light)(Vec3), double least_gain = 1.5) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform;
  GuideBuilder builder;
  for (int n = 0; n < 4000; ++n) {
    const Vec3 direction = cosine_distributed({uniform(random), uniform(random)});
    builder.add(2.5 * direction, light(direction), 1);
  }
  return builder.guide(least_gain);
}

TEST(UnitDisk, SquareOfDiskUndoesTheConcentricMap) {
  for_each_point([](Uv at) {
    const Uv back = square_of_disk(concentric_disk(at));
    ASSERT_NEAR(back.u, at.u, 1e-12);
    ASSERT_NEAR(back.v, at.v, 1e-12);
  });
}

TEST(DirectionGuide, WeightedMeansAreThoseOfCosineDistributedDirections) {
  const DirectionGuide guide = guide_of(beacon);
  ASSERT_FALSE(guide.is_none());
  const DirectionGuide::Warp warp(guide);
  const std::function<double(Vec3)> functions[]{[](Vec3) { return 1; }, [](Vec3 d) { return d.z; },
                                                [](Vec3 d) { return d.x * d.y; }, [](Vec3 d) { return d.x > 0.3 ? d.x : 0; },
                                                beacon};
  for (const auto& f : functions) {
    double guided = 0, unguided = 0;
    for_each_point([&](Uv at) {
      const auto drawn = warp.draw(at);
      ASSERT_NEAR(length(drawn.direction), 1, 1e-6);
      guided += drawn.weight * f(drawn.direction);
      unguided += f(cosine_distributed(at));
    });
    // Both sums are rules with steps of 1/512; the edge of the beacon, 0.2 long and 40 high, may err by a step.
    EXPECT_NEAR(guided / (grid * grid), unguided / (grid * grid), 4e-3);
  }
}

TEST(DirectionGuide, NoRayCountsForMoreThanFour) {
  const DirectionGuide::Warp warp(guide_of(beacon));
  double most = 0;
  for_each_point([&](Uv at) { most = std::max(most, warp.draw(at).weight); });
  EXPECT_LE(most, 4.1);  // codes are whole numbers
  EXPECT_GT(most, 1);
}

TEST(DirectionGuide, ASmallBrightSourceIsFoundWithAQuarterOfTheVariance) {
  const DirectionGuide::Warp warp(guide_of(beacon));
  std::mt19937 random(3);
  double guided = 0, unguided = 0, truth = 0;
  for_each_point([&](Uv at) { truth += beacon(cosine_distributed(at)) / (grid * grid); });
  for (int row = 0; row < 400; ++row) {
    const std::uint32_t first = random(), second = random();
    double by_guide = 0, by_cosine = 0;
    for (std::uint32_t n = 0; n < rays_per_row; ++n) {
      const Uv at = sobol_point(n, first, second);
      const auto drawn = warp.draw(at);
      by_guide += drawn.weight * beacon(drawn.direction) / rays_per_row;
      by_cosine += beacon(cosine_distributed(at)) / rays_per_row;
    }
    guided += (by_guide - truth) * (by_guide - truth);
    unguided += (by_cosine - truth) * (by_cosine - truth);
  }
  EXPECT_LT(guided, unguided / 4);
}

TEST(DirectionGuide, EvenLightNeedsNoGuide) {
  EXPECT_TRUE(guide_of([](Vec3) { return 1.0; }).is_none());
  EXPECT_TRUE(guide_of([](Vec3 d) { return 1 + d.x; }, 1.5).is_none());
  EXPECT_TRUE(GuideBuilder().guide(1.5).is_none());
}

}  // namespace
}  // namespace alvor
