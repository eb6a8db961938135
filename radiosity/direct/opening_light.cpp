#include "radiosity/direct/opening_light.h"

#include "radiosity/direct/face_integral.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace alvor {

OpeningLight::OpeningLight(const LocalScene& scene, std::uint32_t number, const Light& luminaire, const RelativeLight& colour,
                           double power, double greatest)
    : LightSource(number, colour, power),
      web_(luminaire),
      faces_(faces_of_opening(luminaire)),
      greatest_(greatest),
      place_(scene.frame().to_local(luminaire.position)),
      low_(place_),
      high_(place_) {
  const double scale = 1 / scene.frame().metres_per_unit;
  for (OpeningFace& face : faces_) {
    face.centre = scene.frame().to_local(face.centre);
    face.half_u = scale * face.half_u;
    face.half_v = scale * face.half_v;
    face.area *= scale * scale;
    area_ += face.area;
    for (const double u : {-1.0, 1.0})
      for (const double v : {-1.0, 1.0}) {
        const Vec3 corner = face.centre + u * face.half_u + v * face.half_v;
        low_ = lower(low_, corner);
        high_ = upper(high_, corner);
      }
  }
}

/// Returns the area that the opening shows to a far point in this direction (unit).
double OpeningLight::shown_area(Vec3 direction) const {
  double area = 0;
  for (const OpeningFace& face : faces_) area += face.area * std::max(0.0, dot(face.normal, direction));
  return area;
}

/// Returns the irradiance that a face brings per area of the face, from one of its points.
double OpeningLight::brings(const OpeningFace& face, Vec3 from, Vec3 at, Vec3 normal) const {
  const Vec3 way = from - at;
  const double squared = std::max(dot(way, way), nearest_look * nearest_look), distance = std::sqrt(squared);
  const double cosine = dot(way, normal) / distance;
  if (cosine <= 0) return 0;
  const Vec3 direction = -way / distance;
  double per_area = 1 / face.area;
  if (faces_.size() > 1) {
    const double shown = dot(face.normal, direction);
    if (shown <= 0) return 0;
    per_area = shown / shown_area(direction);
  }
  return per_area * cosine / squared * web_.intensity(direction);
}

double OpeningLight::unblocked(Vec3 at, Vec3 normal) const {
  double sum = 0;
  for (const OpeningFace& face : faces_) {
    if (faces_.size() > 1 && dot(at - face.centre, face.normal) <= 0) continue;
    const auto point = [&](Uv uv) { return face.at(uv); };
    const auto brings_here = [&](Vec3 from) { return brings(face, from, at, normal); };
    sum += face.area * FaceIntegral(point, brings_here, 2 * length(face.half_u), 2 * length(face.half_v), at).mean();
  }
  return sum;
}

/// Returns the face that `at` stands for, in proportion to area, and sets `at` to a place on that face.
const OpeningFace& OpeningLight::choose(Uv& at) const {
  double left = at.u * area_;
  std::size_t chosen = 0;
  while (chosen + 1 < faces_.size() && left >= faces_[chosen].area) left -= faces_[chosen++].area;
  at.u = std::min(1.0, left / faces_[chosen].area);
  return faces_[chosen];
}

void OpeningLight::aim(const ShadowAim& aim, std::size_t first, std::size_t last) const {
  for (std::size_t o = first; o < last; ++o) {
    const Vec3 from = aim.start(o);
    Uv at = aim.at[o];
    const OpeningFace& face = choose(at);
    const Vec3 target = face.at(at);
    aim.set(o, target - from, short_of_light, area_ * brings(face, target, from, aim.facing()));
  }
}

std::optional<LightExtent> OpeningLight::extent() const {
  const double intensity = colour().sum() * greatest_;
  return LightExtent{place_, low_, high_, {}, std::numbers::pi * intensity, intensity / (nearest_look * nearest_look)};
}

}  // namespace alvor
