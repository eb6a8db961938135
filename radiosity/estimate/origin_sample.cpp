#include "radiosity/estimate/origin_sample.h"

#include <algorithm>

namespace alvor {

OriginSample sample_of(double light, double squares, double rays) {
  const double mean = light / rays;
  return {mean, std::max(0.0, squares / rays - mean * mean) / (rays - 1)};
}

}  // namespace alvor
