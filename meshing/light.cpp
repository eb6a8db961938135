#include "meshing/light.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace alvor {

namespace {

using std::numbers::pi;

constexpr double max_intensity = 1e30, max_coordinate = 1e9;
// Smallest difference of the cosines of the two cones (KHR_lights_punctual), so that a spot with a sharp edge is a steep one.
constexpr double least_width = 1e-3;

template <class Value>
std::string sentence(const char* what, Value value, const char* reason) {
  std::ostringstream out;
  out << what << ' ' << value << ' ' << reason;
  return out.str();
}

bool is_unit(Vec3 v) { return std::abs(dot(v, v) - 1) < 1e-6; }

}  // namespace

SpotCone::SpotCone(const Light& spot)
    : cosine_of_edge_(std::cos(spot.outer_cone)), width_(std::max(least_width, std::cos(spot.inner_cone) - cosine_of_edge_)) {}

double SpotCone::share(double cosine) const {
  const double edge = std::clamp((cosine - cosine_of_edge_) / width_, 0.0, 1.0);
  return edge * edge;
}

// 2 pi times the integral over the cosine of the square of the linear part and of the part that is 1.
double SpotCone::solid_angle() const {
  const double all = 1 - cosine_of_edge_, edge = std::min(1.0, all / width_);
  return 2 * pi * (width_ * edge * edge * edge / 3 + std::max(0.0, all - width_));
}

Rgb radiated_power(const Light& light) {
  return (light.kind == LightKind::spot ? SpotCone(light).solid_angle() : 4 * pi) * light.intensity;
}

std::optional<std::string> fault_in(const Light& light) {
  for (const double band : {light.intensity.r, light.intensity.g, light.intensity.b})
    if (!(band >= 0 && band <= max_intensity)) return sentence("intensity", band, "is outside [0, 1e30]");
  for (const double x : {light.position.x, light.position.y, light.position.z})
    if (!(std::abs(x) <= max_coordinate)) return sentence("coordinate", x, "is not within 1e9 m");
  if (!is_unit(light.direction)) return "its direction is not a unit vector";
  if (!(light.radius >= 0 && light.radius <= max_coordinate)) return sentence("radius", light.radius, "is outside [0, 1e9] m");
  if (!(light.angular_diameter >= 0 && light.angular_diameter <= pi / 2))
    return sentence("angular diameter", light.angular_diameter, "is outside [0, pi / 2]");
  if (!(light.outer_cone > 0 && light.outer_cone <= pi))
    return sentence("outer cone angle", light.outer_cone, "is outside (0, pi]");
  if (!(light.inner_cone >= 0 && light.inner_cone <= light.outer_cone))
    return sentence("inner cone angle", light.inner_cone, "is outside [0, outer cone angle]");
  return std::nullopt;
}

}  // namespace alvor
