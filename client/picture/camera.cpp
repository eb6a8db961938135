#include "client/picture/camera.h"

#include "radiosity/rays/triangle_caster.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

namespace alvor {
namespace {

constexpr int grid = 24;  ///< trial rays per side of a trial picture

struct Box {
  Vec3 low, high;
  Vec3 centre() const { return lerp(low, high, 0.5); }
  Vec3 size() const { return high - low; }
  /// Returns the point at fractions of the box's sides: (0, 0, 0) is `low`, (1, 1, 1) is `high`.
  Vec3 at(double x, double y, double z) const {
    const Vec3 s = size();
    return {low.x + x * s.x, low.y + y * s.y, low.z + z * s.z};
  }
};

/// Converts directions and positions from y-up axes to the mesh's axes, and back. Views are chosen as if all meshes were y-up.
Vec3 from_upright(UpAxis up, Vec3 p) { return up == UpAxis::y ? p : Vec3{p.x, -p.z, p.y}; }
Vec3 to_upright(UpAxis up, Vec3 p) { return up == UpAxis::y ? p : Vec3{p.x, p.z, -p.y}; }

Box box_of(const DisplayMesh& mesh) {
  const Vec3 first = to_upright(mesh.up, mesh.positions[mesh.triangles[0][0]]);
  Box box{first, first};
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t vertex : triangle) {
      const Vec3 p = to_upright(mesh.up, mesh.positions[vertex]);
      box.low = lower(box.low, p);
      box.high = upper(box.high, p);
    }
  }
  return box;
}

/// Casts trial rays, given in y-up axes, and distinguishes fronts from backs.
class Scout {
 public:
  Scout(const DisplayMesh& mesh, const TriangleCaster& caster) : mesh_(mesh), caster_(caster), box_(box_of(mesh)) {}
  const Box& box() const { return box_; }

  /// Returns +distance if the ray first hits a front, -distance for a back, 0 for nothing.
  double look(Vec3 origin, Vec3 direction) const {
    const Vec3 along = from_upright(mesh_.up, direction);
    const auto hit = caster_.cast(from_upright(mesh_.up, origin), along);
    if (!hit) return 0;
    const auto [a, b, c] = mesh_.triangles[hit->triangle];
    const Vec3 normal = cross(mesh_.positions[b] - mesh_.positions[a], mesh_.positions[c] - mesh_.positions[a]);
    return dot(normal, along) < 0 ? hit->distance : -hit->distance;
  }

 private:
  const DisplayMesh& mesh_;
  const TriangleCaster& caster_;
  Box box_;
};

/// One of the six sides of the bounding box, seen from outside.
struct Side {
  Vec3 inward;          ///< unit, along an axis
  double openness = 0;  ///< in [0, 1]: fraction of rays that enter, weighted by how deep they get
  double backs = 0;     ///< fraction of rays that first hit a back
};

/// Returns the start of a trial ray through a side of the box, just outside it, at (s, t) in [0, 1].
Vec3 start_on(const Box& box, const Vec3& inward, double s, double t) {
  constexpr double outside = 0.01;
  const auto along = [&](double way) { return way > 0 ? -outside : 1 + outside; };
  if (inward.x != 0) return box.at(along(inward.x), s, t);
  if (inward.y != 0) return box.at(s, along(inward.y), t);
  return box.at(s, t, along(inward.z));
}

Side look_through(const Scout& scout, const Vec3& inward) {
  const Vec3 size = scout.box().size();
  const double depth = std::abs(dot(size, inward));
  Side side{inward, 0, 0};
  for (int i = 0; i < grid * grid; ++i) {
    const double s = (i % grid + 0.5) / grid, t = (i / grid + 0.5) / grid;
    const double seen = scout.look(start_on(scout.box(), inward, s, t), inward);
    if (seen > 0 && depth > 0) side.openness += std::min(1.0, seen / depth) / (grid * grid);
    if (seen < 0) side.backs += 1.0 / (grid * grid);
  }
  return side;
}

double half_height(double fov_degrees) { return std::tan(fov_degrees / 2 * std::numbers::pi / 180); }

Camera aimless(double fov_degrees, PictureSize size) {
  Camera camera;
  camera.vertical_fov_degrees = fov_degrees;
  camera.width = size.width;
  camera.height = size.height;
  return camera;
}

/// Returns a view straight through an open side, which just fills the picture. The Cornell box is shown so (39 degrees, eye at z
/// = -800).
Camera view_through(const Box& box, const Side& side, PictureSize size) {
  Camera camera = aimless(39, size);
  const Vec3 extent = box.size(), inward = side.inward;
  const double width = std::abs(inward.x) > 0 ? extent.z : extent.x, depth = std::abs(dot(extent, inward));
  const double tall = std::max(extent.y, width * size.height / size.width);
  const double distance = 1.02 * tall / 2 / half_height(camera.vertical_fov_degrees);
  camera.target = box.centre();
  camera.eye = camera.target - inward * (distance + depth / 2);
  return camera;
}

/// Returns a view from a corner of a closed room, at 60 % of its height, to the opposite corner.
Camera view_from_corner(const Box& box, bool right, bool far, PictureSize size) {
  constexpr double inset = 0.08;
  const double x = right ? 1 - inset : inset, z = far ? 1 - inset : inset;
  Camera camera = aimless(60, size);
  camera.eye = box.at(x, 0.6, z);
  camera.target = box.at(1 - x, 0.4, 1 - z);
  return camera;
}

/// Returns in [0, 1] how much of the room a camera sees; backs in the way count against it.
double worth(const Scout& scout, const Camera& camera) {
  const Viewfinder view(camera);
  const double far = length(scout.box().size());
  double sum = 0;
  for (int i = 0; i < grid * grid; ++i) {
    const double x = (i % grid + 0.5) / grid * camera.width, y = (i / grid + 0.5) / grid * camera.height;
    const double seen = scout.look(view.eye(), view.direction(x, y));
    sum += seen >= 0 ? std::min(1.0, seen / far) : -1;
  }
  return sum / (grid * grid);
}

/// Returns the candidate that sees most. The first wins unless a later one is clearly better.
Camera best_of(const Scout& scout, std::span<const Camera> candidates) {
  constexpr double clearly = 0.02;
  const Camera* best = nullptr;
  double most = -2;
  for (const Camera& candidate : candidates) {
    const double value = worth(scout, candidate);
    if (best && value < most + clearly) continue;
    best = &candidate;
    most = value;
  }
  return *best;
}

Camera view_inside(const Scout& scout, PictureSize size) {
  std::vector<Camera> corners;
  for (const bool right : {false, true})
    for (const bool far : {false, true}) corners.push_back(view_from_corner(scout.box(), right, far, size));
  return best_of(scout, corners);
}

/// Returns a view that has the whole box in the picture. Requires: `towards_eye` is unit.
Camera view_along(const Box& box, const Vec3& towards_eye, PictureSize size) {
  Camera camera = aimless(35, size);
  const double narrow = std::min(1.0, static_cast<double>(size.width) / size.height);
  const double radius = length(box.size()) / 2;
  camera.target = box.centre();
  camera.eye = camera.target + towards_eye * (radius / (narrow * half_height(camera.vertical_fov_degrees)));
  return camera;
}

/// Returns a view from outside: from in front and above if fronts are visible from there, else from another direction.
Camera view_from_outside(const Scout& scout, PictureSize size) {
  std::vector<Camera> views;
  for (const double y : {0.45, -0.45})
    for (const double z : {0.8, -0.8})
      for (const double x : {0.5, -0.5}) views.push_back(view_along(scout.box(), normalized({x, y, z}), size));
  return best_of(scout, views);
}

Camera upright_camera(const Scout& scout, PictureSize size) {
  constexpr std::array<Vec3, 6> ways{{{0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {-1, 0, 0}, {0, -1, 0}, {0, 1, 0}}};
  constexpr int horizontal = 4;
  Side open;
  double backs = 0;
  for (int way = 0; way < 6; ++way) {
    const Side side = look_through(scout, ways[way]);
    if (way < horizontal && side.openness > open.openness + 0.01) open = side;
    backs += side.backs / 6;
  }
  // Rays also enter from all sides if the scene is a plane with objects on it, but then they hit no backs.
  const bool is_room = backs > 0.4;
  if (is_room && open.openness > 0.4) return view_through(scout.box(), open, size);
  if (!is_room) return view_from_outside(scout, size);
  // If all corners are inside walls or furniture, a view from outside through the walls shows more fronts.
  const Camera inside = view_inside(scout, size);
  return worth(scout, inside) > 0.1 ? inside : view_from_outside(scout, size);
}

}  // namespace

Viewfinder::Viewfinder(const Camera& camera) : eye_(camera.eye) {
  const Vec3 forward = normalized(camera.target - camera.eye);
  const Vec3 right = normalized(cross(forward, camera.up)), down = cross(forward, right);
  const double pixel = 2 * half_height(camera.vertical_fov_degrees) / camera.height;
  right_ = right * pixel;
  down_ = down * pixel;
  corner_ = forward - right_ * (camera.width / 2.0) - down_ * (camera.height / 2.0);
}

Vec3 Viewfinder::direction(double x, double y) const { return normalized(corner_ + right_ * x + down_ * y); }

Camera default_camera(const DisplayMesh& mesh, PictureSize size) {
  const TriangleCaster caster(mesh.positions, mesh.triangles);
  return default_camera(mesh, caster, size);
}

Camera default_camera(const DisplayMesh& mesh, const TriangleCaster& caster, PictureSize size) {
  Camera camera = upright_camera(Scout(mesh, caster), size);
  for (Vec3* vector : {&camera.eye, &camera.target, &camera.up}) *vector = from_upright(mesh.up, *vector);
  return camera;
}

}  // namespace alvor
