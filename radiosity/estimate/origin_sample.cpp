#include "radiosity/estimate/origin_sample.h"

#include <algorithm>
#include <cassert>

namespace alvor {

OriginSample sample_of(double light, double squares, double rays) {
  const double mean = light / rays;
  return {mean, std::max(0.0, squares / rays - mean * mean) / (rays - 1)};
}

OriginSample sample_of_guided(std::span<const double> light, std::span<const double> weight) {
  assert(light.size() == weight.size() && light.size() > 1);
  double weighted = 0, weights = 0;
  for (std::size_t r = 0; r < light.size(); ++r) weighted += weight[r] * light[r], weights += weight[r];
  const double mean = weighted / weights;
  double squares = 0;
  for (std::size_t r = 0; r < light.size(); ++r) {
    const double difference = weight[r] * (light[r] - mean);
    squares += difference * difference;
  }
  const auto rays = static_cast<double>(light.size());
  return {mean, squares / (weights * weights) * rays / (rays - 1)};
}

}  // namespace alvor
