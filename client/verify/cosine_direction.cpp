#include "client/verify/cosine_direction.h"

#include <cmath>
#include <numbers>

namespace alvor {

Vec3 cosine_direction(Vec3 normal, UnitPair at) {
  const float angle = static_cast<float>(2 * std::numbers::pi * at.u);
  const double radius = std::sqrt(at.v), x = radius * std::cos(angle), y = radius * std::sin(angle);
  const double sign = std::copysign(1.0, normal.z), a = -1 / (sign + normal.z), b = normal.x * normal.y * a;
  const Vec3 tangent{1 + sign * normal.x * normal.x * a, sign * b, -sign * normal.x};
  const Vec3 bitangent{b, sign + normal.y * normal.y * a, -normal.y};
  return x * tangent + y * bitangent + std::sqrt(1 - at.v) * normal;
}

Vec3 uniform_direction(UnitPair at) {
  const double z = 1 - 2 * at.v, radius = std::sqrt(1 - z * z), angle = 2 * std::numbers::pi * at.u;
  return {radius * std::cos(angle), radius * std::sin(angle), z};
}

}  // namespace alvor
