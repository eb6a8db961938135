#include "radiosity/direct/scene_box.h"

#include <algorithm>
#include <limits>

namespace alvor {

namespace {

// Some hundred roundings of float32.
constexpr double beyond = 1e-5;

}  // namespace

SceneBox::SceneBox(const LocalScene& scene) {
  for (std::uint32_t root = 0; root < scene.mesh().roots().size(); ++root)
    for (const Vec3& corner : scene.corners(root)) {
      low = lower(low, corner);
      high = upper(high, corner);
    }
  const Vec3 margin{beyond, beyond, beyond};
  low = low - margin, high = high + margin;
}

double SceneBox::way_out(Vec3 from, Vec3 direction) const {
  double distance = std::numeric_limits<double>::infinity();
  const auto leave = [&](double at, double step, double lowest, double highest) {
    if (step != 0) distance = std::min(distance, ((step > 0 ? highest : lowest) - at) / step);
  };
  leave(from.x, direction.x, low.x, high.x);
  leave(from.y, direction.y, low.y, high.y);
  leave(from.z, direction.z, low.z, high.z);
  return std::max(0.0, distance);
}

}  // namespace alvor
