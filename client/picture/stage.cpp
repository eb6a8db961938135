#include "client/picture/stage.h"

namespace alvor {

Stage::Stage(const DisplayMesh& mesh)
    : mesh_(mesh), caster_(mesh.positions, mesh.triangles), radiosity_(mesh), transmittance_(mesh) {}

std::optional<Seen> Stage::look(Vec3 origin, Vec3 direction) const {
  if (transmittance_.has_panes()) return look_through_panes(origin, direction);
  const auto hit = caster_.cast_front(origin, direction);
  if (!hit) return std::nullopt;
  return Seen{hit->triangle, hit->u, hit->v};
}

std::optional<Seen> Stage::look_through_panes(Vec3 origin, Vec3 direction) const {
  std::optional<Seen> last;
  RgbF tint{1, 1, 1}, before;
  std::vector<std::uint32_t> passed;
  while (passed.size() < TriangleCaster::most_passed) {
    const auto hit = caster_.cast(origin, direction, passed);
    if (!hit) break;
    passed.push_back(hit->triangle);
    const Rgb through = transmittance_.at(hit->triangle, hit->u, hit->v);
    if (dot(area_vector(hit->triangle), direction) < 0) {
      last = Seen{hit->triangle, hit->u, hit->v, tint, before};
      if (through.is_zero()) return last;
      before = radiosity(*last);
      tint = tint * narrow(through);
    } else if (transmittance_.dims_from_behind(hit->triangle)) {
      tint = tint * narrow(through);
    }
  }
  if (last && radiosity(*last).is_zero()) return std::nullopt;
  return last;
}

void Stage::glance(const Camera& camera, const std::function<void(const Seen&)>& on_seen) const {
  constexpr int columns = 96, rows = 72;
  const Viewfinder view(camera);
  for (int i = 0; i < columns * rows; ++i) {
    const double x = (i % columns + 0.5) / columns * camera.width, y = (i / columns + 0.5) / rows * camera.height;
    if (const auto seen = look(view.eye(), view.direction(x, y))) on_seen(*seen);
  }
}

double Stage::centre_weight(std::uint32_t triangle, Vec3 origin, Vec3 direction) const {
  const Vec3 a = corner(triangle, 0), b = corner(triangle, 1), c = corner(triangle, 2);
  const Vec3 normal = area_vector(triangle);
  const Vec3 point = origin + direction * (dot(b - origin, normal) / dot(direction, normal));
  return dot(cross(b - point, c - point), normal) / dot(cross(b - a, c - a), normal);
}

Vec3 Stage::place(const Seen& seen) const {
  const Vec3 a = corner(seen.triangle, 0);
  return a + seen.u * (corner(seen.triangle, 1) - a) + seen.v * (corner(seen.triangle, 2) - a);
}

Vec3 Stage::area_vector(std::uint32_t triangle) const {
  const Vec3 a = corner(triangle, 0);
  return cross(corner(triangle, 1) - a, corner(triangle, 2) - a);
}

RgbF Stage::interpolated(const std::vector<RgbF>& values, const Seen& seen) const {
  const auto [a, b, c] = mesh_.triangles[seen.triangle];
  const auto u = static_cast<float>(seen.u), v = static_cast<float>(seen.v);
  return (1 - u - v) * values[a] + u * values[b] + v * values[c];
}

}  // namespace alvor
