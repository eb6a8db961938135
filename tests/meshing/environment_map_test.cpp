#include "tests/environments.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace alvor {
namespace {

using std::numbers::pi;

EnvironmentMap stripes(SphereGrid grid) {
  return *test::environment(grid, [](Vec3 d) {
            return Rgb{2 + std::sin(9 * d.x), 1 + d.y * d.y, 3 + std::cos(7 * d.z)};
          }).environment;
}

TEST(SphereGrid, PixelsCoverTheSphereAndAHemisphereBringsPi) {
  const SphereGrid grid{24, 12};
  double all = 0, upright = 0;
  Vec3 sum;
  for (std::uint32_t row = 0; row < grid.rows; ++row)
    for (std::uint32_t column = 0; column < grid.columns; ++column) {
      all += grid.solid_angle(row);
      sum += grid.direction_sum(row, column);
      if (row < 6) upright += grid.direction_sum(row, column).z;
    }
  EXPECT_NEAR(all, 4 * pi, 1e-12);
  EXPECT_NEAR(length(sum), 0, 1e-12);
  EXPECT_NEAR(upright, pi, 1e-12);
}

TEST(SphereGrid, FindsThePixelInWhichADirectionLies) {
  const SphereGrid grid{24, 12};
  for (std::uint32_t row = 0; row < grid.rows; ++row)
    for (std::uint32_t column = 0; column < grid.columns; ++column) {
      EXPECT_EQ(grid.pixel_at(grid.direction_at(column + 0.3, row + 0.7)), row * grid.columns + column);
      const Vec3 sum = grid.direction_sum(row, column);
      EXPECT_EQ(grid.pixel_at(normalized(sum)), row * grid.columns + column);
      EXPECT_NEAR(length(sum), grid.solid_angle(row), 0.02 * grid.solid_angle(row));
    }
  EXPECT_LT(grid.pixel_at({0, 0, -1}), grid.size());
  EXPECT_LT(grid.pixel_at({-1, 0, 0}), grid.size());
}

TEST(EnvironmentReduction, KeepsTheIntegralAtAnyPairOfSizes) {
  for (const SphereGrid from : {SphereGrid{64, 32}, {100, 50}, {37, 19}})
    for (const SphereGrid to : {SphereGrid{64, 32}, {16, 8}, {33, 17}, {1, 1}}) {
      const EnvironmentMap map = stripes(from), less = reduced(map, to.columns, to.rows);
      EXPECT_LE(less.grid.columns, to.columns);
      EXPECT_EQ(less.pixels.size(), less.grid.size());
      for (const double difference :
           {less.total().r / map.total().r, less.total().g / map.total().g, less.total().b / map.total().b})
        EXPECT_NEAR(difference, 1, 1e-6) << from.columns << " to " << to.columns;
    }
}

TEST(EnvironmentMap, ThatCannotBeUsedIsRefused) {
  EnvironmentMap map = stripes({8, 4});
  EXPECT_EQ(fault_in(map), std::nullopt);
  for (const float bad : {-1.0f, std::nanf(""), 1e38f}) {
    map.pixels[7].g = bad;
    EXPECT_EQ(fault_in(map), "a radiance of its environment map is outside [0, 1e30]");
  }
  map = stripes({8, 4});
  map.pixels.pop_back();
  EXPECT_EQ(fault_in(map), "its environment map of 8 x 4 has 31 pixels");
  EXPECT_TRUE(fault_in(EnvironmentMap{}));
  map.grid = {512, 4};
  EXPECT_TRUE(fault_in(map));
  Light light;
  light.kind = LightKind::environment;
  EXPECT_EQ(fault_in(light), "it has no environment map");
  light = test::environment({8, 4}, [](Vec3) { return Rgb{1, 1, 1}; });
  EXPECT_EQ(fault_in(light), std::nullopt);
  light.across = light.direction;
  EXPECT_TRUE(fault_in(light));
}

}  // namespace
}  // namespace alvor
