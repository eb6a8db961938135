#include "meshing/opening_face.h"

#include <cmath>
#include <numbers>

namespace alvor {

namespace {

using std::numbers::pi;

constexpr int sides_of_cylinder = 8;

OpeningFace face(Vec3 centre, Vec3 half_u, Vec3 half_v, Vec3 normal, bool is_round = false) {
  return {centre, half_u, half_v, normal, is_round, (is_round ? pi : 4) * length(half_u) * length(half_v)};
}

/// Returns the length of an ellipse's outline by its half axes (Ramanujan's first formula).
double outline_of_ellipse(double a, double b) { return pi * (3 * (a + b) - std::sqrt((3 * a + b) * (a + 3 * b))); }

}  // namespace

Vec3 OpeningFace::at(Uv at) const {
  const double a = 2 * at.u - 1, b = 2 * at.v - 1;
  if (!is_round || (a == 0 && b == 0)) return centre + a * half_u + b * half_v;
  // Squares about the centre become circles (Shirley and Chiu 1997).
  const bool is_beside = std::abs(a) > std::abs(b);
  const double radius = is_beside ? a : b, angle = is_beside ? pi / 4 * b / a : pi / 2 - pi / 4 * a / b;
  return centre + radius * std::cos(angle) * half_u + radius * std::sin(angle) * half_v;
}

std::vector<OpeningFace> faces_of_opening(const Light& luminaire) {
  using Shape = LuminousOpening::Shape;
  const LuminousOpening& opening = luminaire.opening;
  if (opening.shape == Shape::point || opening.shape == Shape::sphere) return {};
  const HungWeb axes(luminaire);
  const Vec3 x = opening.across / 2 * axes.across(), y = opening.along / 2 * axes.along(), z = opening.height / 2 * axes.aim();
  const Vec3& place = luminaire.position;
  const bool is_round = opening.shape == Shape::ellipse || opening.shape == Shape::cylinder;
  if (opening.shape == Shape::rectangle || opening.shape == Shape::ellipse) return {face(place, x, y, axes.aim(), is_round)};
  std::vector<OpeningFace> faces{face(place + z, x, y, axes.aim(), is_round), face(place - z, x, y, -axes.aim(), is_round)};
  if (!is_round) {
    for (const double sign : {1.0, -1.0}) {
      faces.push_back(face(place + sign * x, y, z, sign * axes.across()));
      faces.push_back(face(place + sign * y, z, x, sign * axes.along()));
    }
    return faces;
  }
  const double half_width = outline_of_ellipse(length(x), length(y)) / (2 * sides_of_cylinder);
  for (int n = 0; n < sides_of_cylinder; ++n) {
    const double angle = 2 * pi * n / sides_of_cylinder, c = std::cos(angle), s = std::sin(angle);
    const Vec3 outwards = normalized(c / length(x) * axes.across() + s / length(y) * axes.along());
    faces.push_back(face(place + c * x + s * y, half_width * cross(axes.aim(), outwards), z, outwards));
  }
  return faces;
}

}  // namespace alvor
