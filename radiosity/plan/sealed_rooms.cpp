#include "radiosity/plan/sealed_rooms.h"

#include <algorithm>
#include <optional>
#include <span>

namespace alvor {

namespace {

// Share of the scene's extent: a point closer to a plane than this lies on it. It is the tolerance within which the mesh welds
// vertices.
constexpr double flat_tolerance = 1e-9;
// Cosine of the angle between normals that count as one direction, 1.4e-6 radians. Chosen; half and double give the same
// solutions (docs/design/constants.md).
constexpr double same_direction = 1 - 1e-12;
// Most sealed rooms that are kept, and most planes of a room. Chosen; half and double give the same solutions
// (docs/design/constants.md).
constexpr std::size_t most_rooms = 64, most_planes = 64;

std::span<const Vec3> corners_of(const RootPatch& root) {
  return std::span(root.corners).first(static_cast<std::size_t>(root.corner_count));
}

bool lets_light_through(const Material& material) { return material.is_pane() || material.is_translucent(); }

/// Finds the sealed rooms among the connected parts of a mesh.
class RoomFinder {
 public:
  explicit RoomFinder(const BaseMesh& mesh) : mesh_(mesh), is_seen_(mesh.roots().size()) {}

  std::vector<SealedRoom> find() {
    std::vector<SealedRoom> rooms;
    for (std::uint32_t root = 0; root < mesh_.roots().size(); ++root)
      if (!is_seen_[root])
        if (auto room = room_of(root)) rooms.push_back(*std::move(room));
    std::ranges::stable_sort(rooms, std::ranges::less{}, &SealedRoom::volume);
    if (rooms.size() > most_rooms) rooms.erase(rooms.begin(), rooms.end() - most_rooms);
    return rooms;
  }

 private:
  /// Returns the connected part of the mesh around `first` if it is a sealed room.
  std::optional<SealedRoom> room_of(std::uint32_t first) {
    std::vector<std::uint32_t> part{first};
    is_seen_[first] = true;
    bool is_closed = true;
    for (std::size_t n = 0; n < part.size(); ++n) {
      const RootPatch& root = mesh_.roots()[part[n]];
      for (int e = 0; e < root.corner_count; ++e) {
        const auto neighbour = mesh_.across(part[n], e);
        is_closed &= neighbour.has_value() && !root.is_hidden && !lets_light_through(mesh_.material_of(part[n]));
        if (!neighbour || is_seen_[neighbour->root]) continue;
        is_seen_[neighbour->root] = true;
        part.push_back(neighbour->root);
      }
    }
    return is_closed ? convex(part) : std::nullopt;
  }

  std::optional<SealedRoom> convex(std::span<const std::uint32_t> part) const {
    SealedRoom room;
    room.origin = mesh_.centre();
    room.tolerance = flat_tolerance * mesh_.extent();
    room.low = room.high = mesh_.roots()[part[0]].corners[0];
    for (const std::uint32_t root : part) {
      add_plane(mesh_.roots()[root], room);
      if (room.planes.size() > most_planes) return std::nullopt;
    }
    for (const std::uint32_t root : part)
      for (const Vec3& p : corners_of(mesh_.roots()[root])) {
        const auto is_behind = [&](const SealedRoom::Plane& plane) {
          return dot(plane.normal, p - mesh_.centre()) < plane.height - room.tolerance;
        };
        if (std::ranges::any_of(room.planes, is_behind)) return std::nullopt;
        room.low = lower(room.low, p);
        room.high = upper(room.high, p);
      }
    for (const std::uint32_t root : part) {
      const RootPatch& wall = mesh_.roots()[root];
      room.volume -= wall.area * dot(wall.normal, wall.corners[0] - mesh_.centre()) / 3;
    }
    const double cube = mesh_.extent() * mesh_.extent() * mesh_.extent();
    if (room.volume <= flat_tolerance * cube) return std::nullopt;
    return room;
  }

  void add_plane(const RootPatch& wall, SealedRoom& room) const {
    const double height = dot(wall.normal, wall.corners[0] - mesh_.centre());
    const bool is_known = std::ranges::any_of(room.planes, [&](const SealedRoom::Plane& plane) {
      return dot(plane.normal, wall.normal) > same_direction && std::abs(plane.height - height) <= room.tolerance;
    });
    if (!is_known) room.planes.push_back({wall.normal, height});
  }

  const BaseMesh& mesh_;
  std::vector<bool> is_seen_;
};

}  // namespace

SealedRoom::Side SealedRoom::side_of(const RootPatch& face) const {
  const auto corners = corners_of(face);
  const auto lies_apart = [&](double Vec3::*axis) {
    const auto along = [axis](const Vec3& p) { return p.*axis; };
    return std::ranges::min(corners, {}, along).*axis > high.*axis + tolerance ||
           std::ranges::max(corners, {}, along).*axis < low.*axis - tolerance;
  };
  if (lies_apart(&Vec3::x) || lies_apart(&Vec3::y) || lies_apart(&Vec3::z)) return Side::outside;
  bool is_inside = true;
  for (const Plane& plane : planes) {
    const auto height = [&](const Vec3& p) { return dot(plane.normal, p - origin) - plane.height; };
    const double lowest = height(std::ranges::min(corners, {}, height)), highest = height(std::ranges::max(corners, {}, height));
    const bool is_in_front = lowest >= -tolerance, is_behind = highest <= tolerance;
    if (is_behind && !(is_in_front && dot(face.normal, plane.normal) > 0)) return Side::outside;
    is_inside &= is_in_front;
  }
  return is_inside ? Side::inside : Side::both;
}

bool SealedRoom::holds(Vec3 point, double margin) const {
  return std::ranges::all_of(
      planes, [&](const Plane& plane) { return dot(plane.normal, point - origin) >= plane.height - tolerance - margin; });
}

std::vector<SealedRoom> find_sealed_rooms(const BaseMesh& mesh) { return RoomFinder(mesh).find(); }

}  // namespace alvor
