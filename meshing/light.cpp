#include "meshing/light.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace alvor {

namespace {

using std::numbers::pi;

constexpr double max_intensity = 1e30, max_coordinate = 1e9, max_watts = 1e9;
// Largest factor by which the radiance of an environment is multiplied. That is at most 1e30, so that irradiance still fits in a
// float after many reflections.
constexpr double max_factor = 1e6;
constexpr double least_opening = 1e-6;  // metres; the area of smaller ones is lost in rounding
// Smallest difference of the cosines of the two cones (KHR_lights_punctual), so that a spot with a sharp edge is a steep one.
constexpr double least_width = 1e-3;

template <class Value>
std::string sentence(const char* what, Value value, const char* reason) {
  std::ostringstream out;
  out << what << ' ' << value << ' ' << reason;
  return out.str();
}

bool is_unit(Vec3 v) { return std::abs(dot(v, v) - 1) < 1e-6; }

std::optional<std::string> fault_in_across(const Light& light) {
  if (!is_unit(light.across) || std::abs(dot(light.across, light.direction)) > 1e-6)
    return "its axis across is not a unit vector perpendicular to its direction";
  return std::nullopt;
}

std::optional<std::string> fault_in_luminaire(const Light& light) {
  if (!light.web) return "it has no photometric web";
  if (auto fault = fault_in_across(light)) return fault;
  if (!(light.electrical_watts >= 0 && light.electrical_watts <= max_watts))
    return sentence("its electrical power", light.electrical_watts, "is outside [0, 1e9] W");
  const LuminousOpening& opening = light.opening;
  for (const double size : {opening.across, opening.along, opening.height})
    if (!(size == 0 || (size >= least_opening && size <= max_coordinate)))
      return sentence("size of its opening", size, "is neither 0 nor within [1e-6, 1e9] m");
  using Shape = LuminousOpening::Shape;
  const bool has_area = opening.shape == Shape::sphere || (opening.across > 0 && opening.along > 0);
  if (opening.shape != Shape::point && !(has_area && opening.across > 0)) return "its opening has no area";
  return std::nullopt;
}

std::optional<std::string> fault_in_environment(const Light& light) {
  if (!light.environment) return "it has no environment map";
  if (light.intensity.max() > max_factor) return sentence("factor", light.intensity.max(), "is outside [0, 1e6]");
  return fault_in_across(light);
}

}  // namespace

bool operator==(const Light& a, const Light& b) {
  const bool is_same_web = a.web == b.web || (a.web && b.web && *a.web == *b.web);
  const bool is_same_map = a.environment == b.environment || (a.environment && b.environment && *a.environment == *b.environment);
  return is_same_web && is_same_map && a.name == b.name && a.kind == b.kind && a.intensity == b.intensity &&
         a.position == b.position && a.direction == b.direction && a.inner_cone == b.inner_cone && a.outer_cone == b.outer_cone &&
         a.radius == b.radius && a.angular_diameter == b.angular_diameter && a.across == b.across && a.opening == b.opening &&
         a.is_hidden == b.is_hidden && a.electrical_watts == b.electrical_watts && a.sky == b.sky;
}

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

double radius_of(const Light& light) {
  const LuminousOpening& opening = light.opening;
  if (light.kind != LightKind::luminaire) return light.radius;
  return length({opening.across, opening.along, opening.height}) / 2;
}

Light moved(Light light, const Placement& motion) {
  if (motion == Placement{}) return light;
  light.position = motion.point(light.position);
  if (light.has_direction()) light.direction = normalized(motion.direction(light.direction));
  if (light.kind == LightKind::luminaire) light.across = normalized(motion.direction(light.across));
  constexpr double rounding = 1e-9;
  const double size = length(motion.x);
  if (std::abs(size - 1) < rounding) return light;
  for (double* each : {&light.radius, &light.opening.across, &light.opening.along, &light.opening.height}) *each *= size;
  return light;
}

Rgb radiated_power(const Light& light) {
  switch (light.kind) {
    case LightKind::spot: return SpotCone(light).solid_angle() * light.intensity;
    case LightKind::luminaire: return light.web->flux() * light.intensity;
    default: return 4 * pi * light.intensity;
  }
}

std::optional<std::string> fault_in(const Light& light) {
  if (light.web)
    if (auto fault = fault_in(*light.web)) return fault;
  if (light.environment)
    if (auto fault = fault_in(*light.environment)) return fault;
  return fault_in_all_but_shared(light);
}

std::optional<std::string> fault_in_all_but_shared(const Light& light) {
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
  if (light.kind == LightKind::sky) return fault_in(light.sky);
  if (light.kind == LightKind::environment) return fault_in_environment(light);
  return light.kind == LightKind::luminaire ? fault_in_luminaire(light) : std::nullopt;
}

}  // namespace alvor
