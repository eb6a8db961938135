#include "radiosity/plan/light_reach.h"

#include "meshing/disjoint_sets.h"
#include "radiosity/plan/sealed_rooms.h"

#include <algorithm>
#include <cmath>

namespace alvor {

namespace {

// Share of the scene's extent: a point lower than this above a plane lies on it. It is the tolerance within which the mesh welds
// vertices.
constexpr double flat_tolerance = 1e-9;
// A face whose normal has at least this cosine from a sky's nadir sees none of the sky.
constexpr double looks_away = 1 - 1e-9;

/// Zones of the scene between which sealed rooms keep light from passing. Zone 0 is outside of all rooms. A face belongs to the
/// smallest room that it is in, and to smaller rooms that it is partly in. A face that belongs to several zones joins them: light
/// passes there.
class Zones {
 public:
  explicit Zones(const BaseMesh& mesh)
      : rooms_(find_sealed_rooms(mesh)), zone_(mesh.roots().size()), joined_(rooms_.size() + 1), is_lit_(joined_.size()) {
    if (rooms_.empty()) return;
    for (std::uint32_t root = 0; root < zone_.size(); ++root) zone_[root] = place(mesh.roots()[root]);
    for (std::uint32_t root = 0; root < zone_.size(); ++root)
      if (!mesh.material_of(root).emission.is_zero()) is_lit_[joined_.find(zone_[root])] = true;
    for (const Light& light : mesh.lights())
      if (!light.is_hidden) light_zones_of(light);
  }

  bool may_be_lit(std::uint32_t root) { return rooms_.empty() || is_lit_[joined_.find(zone_[root])]; }

 private:
  std::uint32_t place(const RootPatch& face) {
    std::uint32_t zone = 0;
    bool has_zone = false;
    const auto add = [&](std::uint32_t other) {
      if (has_zone) joined_.join(other, zone);
      else zone = other;
      has_zone = true;
    };
    for (std::uint32_t room = 0; room < rooms_.size(); ++room) {
      const SealedRoom::Side side = rooms_[room].side_of(face);
      if (side != SealedRoom::Side::outside) add(room + 1);
      if (side == SealedRoom::Side::inside) return zone;
    }
    add(0);
    return zone;
  }
  /// Marks the zones that a light may be in. Distant light comes from outside of all rooms. A lamp counts for each room that a
  /// sphere about all of it meets, which is safe.
  void light_zones_of(const Light& light) {
    bool is_inside = false;
    for (std::uint32_t room = 0; room < rooms_.size() && !light.is_distant(); ++room) {
      if (!rooms_[room].holds(light.position, radius_of(light))) continue;
      is_lit_[joined_.find(room + 1)] = true;
      is_inside = is_inside || rooms_[room].holds(light.position, -radius_of(light));
    }
    if (!is_inside) is_lit_[joined_.find(0)] = true;
  }

  std::vector<SealedRoom> rooms_;    // smallest first
  std::vector<std::uint32_t> zone_;  // by root
  DisjointSets joined_;              // zones between which light passes
  std::vector<bool> is_lit_;         // by the zone that stands for its set
};

/// Returns the height of the face's lowest corner along its normal, above `centre`.
double height_of(const RootPatch& face, Vec3 centre) {
  double height = dot(face.normal, face.corners[0] - centre);
  for (int c = 1; c < face.corner_count; ++c) height = std::min(height, dot(face.normal, face.corners[c] - centre));
  return height;
}

bool faces(const Light& distant, Vec3 normal) {
  if (distant.kind == LightKind::environment) return true;
  if (distant.kind == LightKind::sky) return dot(normal, distant.direction) < looks_away;
  return dot(normal, distant.direction) < std::sin(distant.angular_diameter / 2);
}

}  // namespace

LightReach::LightReach(const BaseMesh& mesh, const PointTree& corners) : is_dark(mesh.roots().size()) {
  Zones zones(mesh);
  std::vector<const Light*> distant;  // few, of maybe many lights
  for (const Light& light : mesh.lights())
    if (light.is_distant()) distant.push_back(&light);
  for (std::uint32_t root = 0; root < is_dark.size(); ++root) {
    const RootPatch& face = mesh.roots()[root];
    is_dark[root] = face.is_hidden;
    hidden += face.is_hidden;
    if (face.is_hidden) continue;
    const double height = height_of(face, mesh.centre());
    const bool faces_nothing = !corners.any_above(face.normal, height + flat_tolerance * mesh.extent()) &&
                               std::ranges::none_of(distant, [&](const Light* light) { return faces(*light, face.normal); });
    const bool is_shut_off = !faces_nothing && !zones.may_be_lit(root);
    facing_nothing += faces_nothing;
    shut_off += is_shut_off;
    is_dark[root] = faces_nothing || is_shut_off;
  }
}

}  // namespace alvor
