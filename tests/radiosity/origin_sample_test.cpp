// Tests of what the rays of one origin tell.

#include "radiosity/estimate/origin_sample.h"

#include "tests/random/dice.h"

#include <gtest/gtest.h>

#include <vector>

namespace alvor {
namespace {

TEST(OriginSample, OfEvenLightIsThatLightWithoutNoise) {
  const std::vector<double> even(16, 10.0), weights{4, 0.3, 0.3, 4, 0.3, 0.3, 0.3, 4, 0.3, 0.3, 0.3, 0.3, 4, 0.3, 0.3, 0.3};
  EXPECT_EQ(sample_of(160, 1600, 16).irradiance, 10);
  EXPECT_EQ(sample_of(160, 1600, 16).noise, 0);
  EXPECT_DOUBLE_EQ(sample_of_guided(even, weights).irradiance, 10);
  EXPECT_NEAR(sample_of_guided(even, weights).noise, 0, 1e-24);
}

TEST(OriginSample, OfGuidedRaysOfEqualWeightIsThatOfUnguidedOnes) {
  const std::vector<double> light{1, 3, 2, 7, 0, 0, 5, 1}, weights(8, 1.0);
  double sum = 0, squares = 0;
  for (const double l : light) sum += l, squares += l * l;
  const OriginSample guided = sample_of_guided(light, weights), unguided = sample_of(sum, squares, 8);
  EXPECT_DOUBLE_EQ(guided.irradiance, unguided.irradiance);
  EXPECT_NEAR(guided.noise, unguided.noise, 1e-12);
}

// Half of all directions are dark, half have light 1, found with densities 1.75 and 0.25: the mean is a half.
TEST(OriginSample, OfGuidedRaysHasTheMeanOfAllDirectionsAndTellsItsNoise) {
  test::Dice dice(5);
  constexpr int samples = 20'000;
  double sum = 0, squares = 0, told = 0;
  for (int n = 0; n < samples; ++n) {
    std::vector<double> light, weights;
    for (int r = 0; r < 64; ++r) {
      const bool is_lit = dice.happens(0.875);
      light.push_back(is_lit), weights.push_back(1 / (is_lit ? 1.75 : 0.25));
    }
    const OriginSample sample = sample_of_guided(light, weights);
    sum += sample.irradiance, squares += sample.irradiance * sample.irradiance, told += sample.noise;
  }
  const double mean = sum / samples, variance = squares / samples - mean * mean;
  EXPECT_NEAR(mean, 0.5, 0.02);  // a ratio of sums over 64 rays is biased by a few hundredths of its value
  EXPECT_NEAR(told / samples, variance, 0.15 * variance);
}

}  // namespace
}  // namespace alvor
