#include "meshing/photometric_web.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

namespace alvor {

namespace {

using std::numbers::pi;

constexpr double degrees = 180 / pi;
constexpr double full_turn = 360;
// Files round angles: an angle beyond its range by less is at its end, degrees.
constexpr double rounding = 1e-6;
constexpr double max_intensity = 1e30;
// Smallest step between angles, degrees: no goniometer is finer, and sums over smaller ones would lose their digits.
constexpr double smallest_step = 1e-3;

/// A place between two entries of a list: the first of them, and the share of the second.
struct Between {
  std::size_t first;
  double share;
};

Between place_in(std::span<const double> list, double value) {
  if (list.size() < 2) return {0, 0};
  const auto above = std::upper_bound(list.begin() + 1, list.end() - 1, value);
  const auto first = static_cast<std::size_t>(above - list.begin()) - 1;
  return {first, std::clamp((value - list[first]) / (list[first + 1] - list[first]), 0.0, 1.0)};
}

bool is_outside(std::span<const double> list, double value) {
  return value < list.front() - rounding || value > list.back() + rounding;
}

/// Returns the integral of sin t times the linear function with values a at `from` and b at `to`, radians.
double integral_with_sine(double from, double to, double a, double b) {
  const double slope = (b - a) / (to - from);
  return a * std::cos(from) - b * std::cos(to) + slope * (std::sin(to) - std::sin(from));
}

/// Returns whether each angle is a number and larger than the one before by more than rounding. NaN compares as not larger.
bool is_ascending(std::span<const double> list) {
  for (std::size_t n = 1; n < list.size(); ++n)
    if (!(list[n] - list[n - 1] >= smallest_step)) return false;
  return std::isfinite(list.front());
}

}  // namespace

double PhotometricWeb::at(double plane, double angle) const {
  if (is_outside(angles, angle)) return 0;
  const Between a = place_in(angles, angle), p = place_in(planes, plane);
  const auto in_plane = [&](std::size_t which) {
    const float* row = intensities.data() + which * angles.size() + a.first;
    return a.share > 0 ? row[0] + a.share * (double{row[1]} - row[0]) : double{row[0]};
  };
  const double first = in_plane(p.first);
  return p.share > 0 ? first + p.share * (in_plane(p.first + 1) - first) : first;
}

double PhotometricWeb::intensity(Vec3 d) const {
  const auto angle_to = [](double cosine) { return std::acos(std::clamp(cosine, -1.0, 1.0)) * degrees; };
  if (axis == Axis::aim) {
    if (planes.size() == 1) return at(0, angle_to(d.z));
    const double plane = std::atan2(d.y, d.x) * degrees;
    return at(plane < 0 ? plane + full_turn : plane, angle_to(d.z));
  }
  const double plane = std::atan2(-d.y, d.z) * degrees;
  return is_outside(planes, plane) ? 0 : at(plane, angle_to(d.x));
}

double PhotometricWeb::flux() const {
  const auto of_plane = [&](std::size_t which) {
    const float* row = intensities.data() + which * angles.size();
    double sum = 0;
    for (std::size_t a = 0; a + 1 < angles.size(); ++a)
      sum += integral_with_sine(angles[a] / degrees, angles[a + 1] / degrees, double{row[a]}, double{row[a + 1]});
    return sum;
  };
  if (planes.size() == 1) return 2 * pi * of_plane(0);
  double sum = 0, last = of_plane(0);
  for (std::size_t p = 1; p < planes.size(); ++p) {
    const double next = of_plane(p);
    sum += (planes[p] - planes[p - 1]) / degrees * (last + next) / 2;
    last = next;
  }
  return sum;
}

float PhotometricWeb::greatest() const { return *std::ranges::max_element(intensities); }

std::optional<std::string> fault_in(const PhotometricWeb& web) {
  if (web.angles.size() < 2) return "its photometric web has fewer than two angles";
  if (web.planes.empty()) return "its photometric web has no planes";
  const std::size_t count = web.angles.size() * web.planes.size();
  if (count > PhotometricWeb::most_intensities)
    return "its photometric web has " + std::to_string(count) + " intensities, at most 200000 are possible";
  if (web.intensities.size() != count)
    return "its photometric web has " + std::to_string(web.intensities.size()) + " intensities, needs " + std::to_string(count);
  if (!is_ascending(web.angles) || !is_ascending(web.planes)) return "the angles of its photometric web do not ascend";
  if (!(web.angles.front() >= -rounding && web.angles.back() <= 180 + rounding))
    return "an angle of its photometric web is outside [0, 180] degrees";
  const bool is_about_aim = web.axis == PhotometricWeb::Axis::aim;
  if (is_about_aim && web.planes.size() > 1 &&
      (std::abs(web.planes.front()) > rounding || std::abs(web.planes.back() - full_turn) > rounding))
    return "the planes of its photometric web do not go from 0 to 360 degrees";
  if (!is_about_aim && (web.planes.size() < 2 || !(web.planes.front() >= -180 - rounding && web.planes.back() <= 180 + rounding)))
    return "the planes of its photometric web are not two or more within [-180, 180] degrees";
  for (const float intensity : web.intensities)
    if (!(intensity >= 0 && intensity <= max_intensity))
      return "intensity " + std::to_string(intensity) + " of its photometric web is outside [0, 1e30]";
  return std::nullopt;
}

}  // namespace alvor
