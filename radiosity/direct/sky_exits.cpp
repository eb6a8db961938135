#include "radiosity/direct/sky_exits.h"

#include "radiosity/direct/scene_box.h"
#include "radiosity/rays/sampling.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

namespace alvor {

namespace {

// Rays in all, spread evenly over the faces, and the least for each face. Chosen: 2^18 rays take a tenth of a second.
constexpr std::uint32_t rays_in_all = 1u << 18, least_packets_of_face = 1, most_packets_of_face = 2048;
// Share of its rays that leave the scene from which on a face looks for the sky in all directions: then few of its shadow rays
// are blocked. Chosen; not measured at half and double.
constexpr double open_share = 0.25;
// Cells along a side of the bounding box in which exits are told apart, and most exits of one side.
constexpr int cells = 48;
constexpr std::size_t most_exits_of_side = 6;

/// A place where a ray left the bounding box: its side 0 to 5 (low x, high x, low y, ...), and shares of the box along the two
/// other axes.
struct Leaving {
  int side;
  double u, v;
};

double along(Vec3 v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

Leaving leave(const SceneBox& box, Vec3 from, Vec3 direction) {
  double nearest = std::numeric_limits<double>::infinity();
  Leaving leaving{0, 0, 0};
  for (int axis = 0; axis < 3; ++axis) {
    const double step = along(direction, axis);
    if (step == 0) continue;
    const double distance = (along(step > 0 ? box.high : box.low, axis) - along(from, axis)) / step;
    if (distance < nearest) nearest = distance, leaving.side = 2 * axis + (step > 0);
  }
  const Vec3 at = from + std::max(0.0, nearest) * direction;
  const auto share = [&](int axis) {
    const double low = along(box.low, axis), high = along(box.high, axis);
    return std::clamp((along(at, axis) - low) / (high - low), 0.0, 1.0);
  };
  leaving.u = share((leaving.side / 2 + 1) % 3);
  leaving.v = share((leaving.side / 2 + 2) % 3);
  return leaving;
}

/// A rectangle that holds places on one side of the box, shares of the side.
struct Rectangle {
  double low_u = 1, low_v = 1, high_u = 0, high_v = 0;
  std::size_t places = 0;

  void add(double u, double v) {
    low_u = std::min(low_u, u), high_u = std::max(high_u, u);
    low_v = std::min(low_v, v), high_v = std::max(high_v, v);
    ++places;
  }
  void add(const Rectangle& other) {
    add(other.low_u, other.low_v);
    add(other.high_u, other.high_v);
    places += other.places - 2;
  }
  bool meets(const Rectangle& other) const {
    return low_u <= other.high_u && other.low_u <= high_u && low_v <= other.high_v && other.low_v <= high_v;
  }
  /// Grows by four times the gap that is expected between the outermost of so many places and the edge of the hole that they came
  /// through. Of the light that comes through a hole of any shape, about that share is missed at most.
  void grow() {
    const auto count = static_cast<double>(places);
    const auto widen = [&](double& low, double& high) {
      const double gap = 4 * (high - low + 1.0 / cells / count) / (count + 1);
      low = std::max(0.0, low - gap), high = std::min(1.0, high + gap);
    };
    widen(low_u, high_u);
    widen(low_v, high_v);
  }
};

/// Joins rectangles that meet, so that no direction counts twice.
void join_meeting(std::vector<Rectangle>& list) {
  std::vector<Rectangle> apart;
  while (!list.empty()) {
    Rectangle next = list.back();
    list.pop_back();
    // What the next one meets is joined with it and looked at again, as it may have grown into others.
    const auto met = std::partition(apart.begin(), apart.end(), [&](const Rectangle& other) { return !other.meets(next); });
    const bool has_grown = met != apart.end();
    std::for_each(met, apart.end(), [&](const Rectangle& other) { next.add(other); });
    apart.erase(met, apart.end());
    (has_grown ? list : apart).push_back(next);
  }
  list = std::move(apart);
}

/// Returns rectangles about the groups of places on one side of the box; cells that touch are one group.
std::vector<Rectangle> groups_of(std::span<const Leaving> places, int side) {
  std::vector<int> group(cells * cells, -1);
  std::vector<Rectangle> in_cell(cells * cells);
  const auto cell_of = [](double share) { return std::min(cells - 1, static_cast<int>(share * cells)); };
  for (const Leaving& place : places)
    if (place.side == side) in_cell[static_cast<std::size_t>(cell_of(place.v) * cells + cell_of(place.u))].add(place.u, place.v);
  std::vector<Rectangle> groups;
  for (int start = 0; start < cells * cells; ++start) {
    if (in_cell[static_cast<std::size_t>(start)].places == 0 || group[static_cast<std::size_t>(start)] >= 0) continue;
    Rectangle rectangle;
    std::vector<int> open{start};
    group[static_cast<std::size_t>(start)] = static_cast<int>(groups.size());
    while (!open.empty()) {
      const int cell = open.back();
      open.pop_back();
      rectangle.places == 0 ? void(rectangle = in_cell[static_cast<std::size_t>(cell)])
                            : rectangle.add(in_cell[static_cast<std::size_t>(cell)]);
      for (int dv = -1; dv <= 1; ++dv)
        for (int du = -1; du <= 1; ++du) {
          const int u = cell % cells + du, v = cell / cells + dv;
          if (u < 0 || v < 0 || u >= cells || v >= cells) continue;
          const auto next = static_cast<std::size_t>(v * cells + u);
          if (in_cell[next].places == 0 || group[next] >= 0) continue;
          group[next] = static_cast<int>(groups.size());
          open.push_back(static_cast<int>(next));
        }
    }
    groups.push_back(rectangle);
  }
  for (Rectangle& rectangle : groups) rectangle.grow();
  join_meeting(groups);
  if (groups.size() > most_exits_of_side) {
    for (std::size_t n = 1; n < groups.size(); ++n) groups[0].add(groups[n]);
    groups.resize(1);
  }
  return groups;
}

SkyExit exit_at(const SceneBox& box, int side, const Rectangle& r) {
  const int axis = side / 2, u_axis = (axis + 1) % 3, v_axis = (axis + 2) % 3;
  const auto unit = [](int which) { return Vec3{which == 0 ? 1.0 : 0.0, which == 1 ? 1.0 : 0.0, which == 2 ? 1.0 : 0.0}; };
  const Vec3 size = box.high - box.low;
  const double size_u = along(size, u_axis), size_v = along(size, v_axis);
  const Vec3 corner = along(side % 2 == 1 ? box.high : box.low, axis) * unit(axis) +
                      (along(box.low, u_axis) + r.low_u * size_u) * unit(u_axis) +
                      (along(box.low, v_axis) + r.low_v * size_v) * unit(v_axis);
  return {corner, (r.high_u - r.low_u) * size_u * unit(u_axis), (r.high_v - r.low_v) * size_v * unit(v_axis),
          (side % 2 == 1 ? -1.0 : 1.0) * unit(axis)};
}

/// Sends rays from one face: a direction each from points spread over it.
class FaceRays {
 public:
  FaceRays(const LocalScene& scene, std::uint32_t root, std::uint32_t packets) : rays_(packets), hits_(packets) {
    const LocalRoot& local = scene.root(root);
    const auto vec = [](Float3 v) { return Vec3{v.x, v.y, v.z}; };
    const Vec3 normal = vec(local.normal);
    const RootPatch& patch = scene.mesh().roots()[root];
    const auto scramble = static_cast<std::uint32_t>(mix_bits(root));
    for (std::uint32_t n = 0; n < packets * RayPacket::width; ++n) {
      const Uv at = on_face(patch.corner_count, sobol_point(n, scramble, scramble * 0x9e3779b9u));
      const Uv way = sobol_point(n, ~scramble, scramble * 0x85ebca6bu);
      const double radius = std::sqrt(way.u), angle = 2 * std::numbers::pi * way.v;
      const Vec3 direction = radius * std::cos(angle) * vec(local.tangent) + radius * std::sin(angle) * vec(local.bitangent) +
                             std::sqrt(1 - way.u) * normal;
      set(n, scene.frame().to_local(patch.at(at.u, at.v)) + off_surface * normal, direction);
    }
    scene.visibility().closest_hits(rays_, hits_);
  }

  /// Calls `take(from, direction)` for each ray that left the scene.
  template <class Take>
  void for_each_way_out(Take&& take) const {
    for (std::size_t n = 0; n < from_.size(); ++n)
      if (hits_[n / RayPacket::width].root[n % RayPacket::width] == HitPacket::nothing) take(from_[n], way_[n]);
  }
  std::size_t size() const { return from_.size(); }

 private:
  // Height above the face at which rays start, local units: some roundings of float32.
  static constexpr double off_surface = 1e-6;
  // Length of a way that leads out of the scene from any place in it, local units.
  static constexpr float way_through = 4;

  void set(std::uint32_t n, Vec3 from, Vec3 direction) {
    rays_[n / RayPacket::width].set(n % RayPacket::width, from, direction, way_through);
    from_.push_back(from);
    way_.push_back(direction);
  }

  std::vector<RayPacket> rays_;
  std::vector<HitPacket> hits_;
  std::vector<Vec3> from_, way_;
};

}  // namespace

SkyExits::SkyExits(const LocalScene& scene, std::vector<WayOut>& ways_out) : is_open(scene.mesh().roots().size()) {
  const auto roots = static_cast<std::uint32_t>(is_open.size());
  const SceneBox box(scene);
  const std::uint32_t packets =
      std::clamp(rays_in_all / RayPacket::width / std::max(1u, roots), least_packets_of_face, most_packets_of_face);
  const double metres = scene.frame().metres_per_unit;
  std::vector<Leaving> places;
  for (std::uint32_t root = 0; root < roots; ++root) {
    const FaceRays rays(scene, root, packets);
    std::size_t left = 0;
    rays.for_each_way_out([&](Vec3, Vec3) { ++left; });
    is_open[root] = static_cast<double>(left) > open_share * static_cast<double>(rays.size());
    any_open = any_open || is_open[root];
    const double area = scene.mesh().roots()[root].area / (metres * metres) / static_cast<double>(rays.size());
    rays.for_each_way_out([&](Vec3 from, Vec3 direction) {
      ways_out.push_back({direction, area, is_open[root]});
      if (!is_open[root]) places.push_back(leave(box, from, direction));
    });
  }
  for (int side = 0; side < 6; ++side)
    for (const Rectangle& rectangle : groups_of(places, side)) exits.push_back(exit_at(box, side, rectangle));
}

}  // namespace alvor
