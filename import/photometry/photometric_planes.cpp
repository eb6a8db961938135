#include "import/photometry/photometric_planes.h"

#include <algorithm>
#include <cmath>

namespace alvor {

namespace {

constexpr double full_turn = 360;
// Planes closer than this are the same plane, degrees.
constexpr double same_plane = 1e-3;

double wrapped(double angle) {
  angle = std::fmod(angle, full_turn);
  if (angle < 0) angle += full_turn;
  return angle > full_turn - same_plane ? 0 : angle;
}

void add_mirrored(std::vector<PhotometricPlane>& planes, double sum_of_angles) {
  const std::size_t count = planes.size();
  for (std::size_t n = 0; n < count; ++n) planes.push_back({wrapped(sum_of_angles - planes[n].angle), planes[n].intensities});
}

/// Returns the plane at 0 degrees between the last and the first plane of a full turn.
PhotometricPlane plane_at_0(const std::vector<PhotometricPlane>& planes) {
  const PhotometricPlane &before = planes.back(), &after = planes.front();
  const double gap = full_turn - before.angle, share = gap / (gap + after.angle);
  PhotometricPlane plane{0, before.intensities};
  for (std::size_t a = 0; a < plane.intensities.size(); ++a)
    plane.intensities[a] += static_cast<float>(share) * (after.intensities[a] - before.intensities[a]);
  return plane;
}

}  // namespace

void complete(PhotometricWeb& web, std::vector<PhotometricPlane> planes, PlaneMirrors mirrors) {
  web.planes.clear();
  web.intensities.clear();
  if (planes.size() == 1) {
    web.planes = {0};
    web.intensities = std::move(planes.front().intensities);
    return;
  }
  for (PhotometricPlane& plane : planes) plane.angle = wrapped(plane.angle);
  if (mirrors.at_0_and_180) add_mirrored(planes, full_turn);
  if (mirrors.at_90_and_270) add_mirrored(planes, full_turn / 2);
  std::ranges::stable_sort(planes, {}, &PhotometricPlane::angle);
  const auto is_same = [](const PhotometricPlane& a, const PhotometricPlane& b) { return b.angle - a.angle < same_plane; };
  planes.erase(std::unique(planes.begin(), planes.end(), is_same), planes.end());
  if (planes.front().angle > same_plane) planes.insert(planes.begin(), plane_at_0(planes));
  planes.front().angle = 0;
  planes.push_back({full_turn, planes.front().intensities});
  for (const PhotometricPlane& plane : planes) {
    web.planes.push_back(plane.angle);
    web.intensities.insert(web.intensities.end(), plane.intensities.begin(), plane.intensities.end());
  }
}

}  // namespace alvor
