#include "radiosity/exchange/field_equations.h"

#include <gtest/gtest.h>

#include <cmath>

namespace alvor {
namespace {

TEST(FieldEquations, FindAPlaneFromAnyNumberOfSamples) {
  for (const int count : {5, 6, 7, 8, 100, 192, 193}) {
    SampleBlocks samples;
    for (int n = 0; n < count; ++n) {
      const double s = std::cos(2.4 * n) * std::sqrt(n) / 15, t = std::sin(2.4 * n) * std::sqrt(n) / 15;
      const double value = 3 + 2 * s - t;
      samples.add({s, t, 16, value, 2 * value, 0});
    }
    const auto plane = FieldEquations<3>(samples, 1.5).solve();
    ASSERT_TRUE(plane) << count;
    EXPECT_NEAR(plane->coefficient[0].r, 3, 1e-9);
    EXPECT_NEAR(plane->coefficient[1].g, 4, 1e-9);
    EXPECT_NEAR(plane->coefficient[2].r, -1, 1e-9);
    EXPECT_NEAR(plane->misfit, 0, 1e-9);
    EXPECT_NEAR(plane->noise, 1.0 / 16, 1e-12);
    EXPECT_EQ(bool(FieldEquations<6>(samples, 1.5).solve()), count >= 9);
  }
}

}  // namespace
}  // namespace alvor
