#include "client/verify/error_field.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace alvor {

namespace {

constexpr float least_cosine = 0.5f;  ///< least cosine between normals that count as facing the same way

Extent extent_of_points(const Verification& verification) {
  std::vector<Vec3> places;
  for (const VerifiedPoint& point : verification.points) places.push_back(point.at.position);
  return extent_of(std::span<const Vec3>(places));
}

std::array<float, 3> floats(Vec3 v) { return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)}; }

}  // namespace

// The spacing assumes that the points lie on the six sides of a box, which is near enough.
ErrorField::ErrorField(const Verification& verification) {
  assert(verification.errors.points > 0);
  const Extent extent = extent_of_points(verification);
  centre_ = extent.centre;
  spacing_ = extent.longest_side * std::sqrt(6.0 / static_cast<double>(verification.errors.points));
  std::size_t n = 0;
  for (const VerifiedPoint& point : verification.points) {
    if (point.standing != Standing::counts) continue;
    if (n % width == 0) groups_.emplace_back();
    Group& group = groups_.back();
    const std::size_t k = n++ % width;
    const auto place = floats((point.at.position - centre_) / spacing_), normal = floats(point.at.normal);
    group.x[k] = place[0], group.y[k] = place[1], group.z[k] = place[2];
    group.normal_x[k] = normal[0], group.normal_y[k] = normal[1], group.normal_z[k] = normal[2];
    group.error[k] = static_cast<float>(point.error());
    group.truth[k] = static_cast<float>(point.truth.mean().mean());
    group.variance[k] = static_cast<float>(point.truth.variance_of_band_mean());
  }
}

// The inner loop runs over SIMD lanes; each lane has its own sums.
ErrorField::Sums ErrorField::sums_around(const std::array<float, 3>& place, const std::array<float, 3>& normal) const {
  // `softening` is the squared distance within which points weigh alike, so that their noise is averaged.
  constexpr float far = 1e30f, softening = 0.1f;
  std::array<float, width> errors{}, truths{}, variances{}, nearest;
  nearest.fill(far);
  for (const Group& group : groups_)
    for (std::size_t k = 0; k < width; ++k) {
      const float dx = group.x[k] - place[0], dy = group.y[k] - place[1], dz = group.z[k] - place[2];
      const float cosine = group.normal_x[k] * normal[0] + group.normal_y[k] * normal[1] + group.normal_z[k] * normal[2];
      const float square = cosine > least_cosine ? dx * dx + dy * dy + dz * dz : far;
      const float weight = 1 / ((square + softening) * (square + softening));
      errors[k] += weight * group.error[k];
      truths[k] += weight * group.truth[k];
      variances[k] += weight * weight * group.variance[k];
      nearest[k] = std::min(nearest[k], square);
    }
  Sums sums;
  for (std::size_t k = 0; k < width; ++k) sums.error += errors[k], sums.truth += truths[k], sums.variance += variances[k];
  sums.nearest = *std::ranges::min_element(nearest);
  return sums;
}

ErrorField::Value ErrorField::at(Vec3 where, Vec3 normal) const {
  const Sums sums = sums_around(floats((where - centre_) / spacing_), floats(normal));
  const double distance = spacing_ * std::sqrt(sums.nearest);
  if (!(sums.truth > 0) || sums.error == 0) return {0, distance};
  const double certain = std::max(0.0, 1 - sums.variance / (sums.error * sums.error));
  return {certain * sums.error / sums.truth, distance};
}

}  // namespace alvor
