// Tests of what the rays of one origin tell.

#include "radiosity/estimate/origin_sample.h"

#include "tests/random/dice.h"

#include <gtest/gtest.h>

#include <cmath>

namespace alvor {
namespace {

TEST(OriginSample, OfEvenLightIsThatLightWithoutNoise) {
  EXPECT_EQ(sample_of(160, 1600, 16).irradiance, 10);
  EXPECT_EQ(sample_of(160, 1600, 16).noise, 0);
  GuidedOrigin guided(10);
  for (const double weight : {4.0, 0.3, 0.3, 4.0, 0.3, 0.3, 0.3, 0.3, 4.0, 0.3}) guided.add(10, weight);
  EXPECT_EQ(guided.sample().irradiance, 10);
  EXPECT_EQ(guided.sample().noise, 0);
}

TEST(OriginSample, OfGuidedRaysOfEqualWeightIsThatOfUnguidedOnes) {
  double sum = 0, squares = 0;
  GuidedOrigin guided(2.5);
  for (const double light : {1, 3, 2, 7, 0, 0, 5, 1}) sum += light, squares += light * light, guided.add(light, 1);
  const OriginSample unguided = sample_of(sum, squares, 8);
  EXPECT_DOUBLE_EQ(guided.sample().irradiance, unguided.irradiance);
  EXPECT_NEAR(guided.sample().noise, unguided.noise, 1e-12);
}

// Half of all directions are dark, half have light 1, found with densities 1.75 and 0.25: the mean is a half.
TEST(OriginSample, OfGuidedRaysHasTheMeanOfAllDirectionsAndTellsItsNoise) {
  for (const double around : {0.0, 0.4, 2.0}) {
    test::Dice dice(5);
    constexpr int samples = 50'000;
    double sum = 0, squares = 0, told = 0;
    for (int n = 0; n < samples; ++n) {
      GuidedOrigin origin(around);
      for (int r = 0; r < 16; ++r) {
        const bool is_lit = dice.happens(0.875);
        origin.add(is_lit, 1 / (is_lit ? 1.75 : 0.25));
      }
      const OriginSample sample = origin.sample();
      sum += sample.irradiance, squares += sample.irradiance * sample.irradiance, told += sample.noise;
    }
    const double mean = sum / samples, variance = squares / samples - mean * mean;
    EXPECT_NEAR(mean, 0.5, 5 * std::sqrt(variance / samples)) << around;
    EXPECT_NEAR(told / samples, variance, 0.05 * variance) << around;
  }
}

}  // namespace
}  // namespace alvor
