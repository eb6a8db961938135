#include "radiosity/plan/light_reach.h"

#include "radiosity/plan/sealed_rooms.h"

#include <algorithm>
#include <numeric>

namespace alvor {

namespace {

constexpr double flat_tolerance = 1e-9;  // of the extent: what is lower than this above a plane is on it

/// Each face belongs to the smallest room that it is in, and to those it is partly in; light goes where a face belongs to both.
/// Zone 0 is outside of all rooms.
class Zones {
 public:
  explicit Zones(const BaseMesh& mesh)
      : rooms_(find_sealed_rooms(mesh)), zone_(mesh.roots().size()), joined_(rooms_.size() + 1), is_lit_(joined_.size()) {
    std::iota(joined_.begin(), joined_.end(), 0u);
    if (rooms_.empty()) return;
    for (std::uint32_t root = 0; root < zone_.size(); ++root) zone_[root] = place(mesh.roots()[root]);
    for (std::uint32_t root = 0; root < zone_.size(); ++root)
      if (!mesh.material_of(root).emission.is_zero()) is_lit_[find(zone_[root])] = true;
  }

  bool may_be_lit(std::uint32_t root) const { return rooms_.empty() || is_lit_[find(zone_[root])]; }

 private:
  std::uint32_t place(const RootPatch& face) {
    std::uint32_t zone = 0;
    bool has_zone = false;
    const auto add = [&](std::uint32_t other) {
      if (has_zone) joined_[find(other)] = find(zone);
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
  std::uint32_t find(std::uint32_t zone) const {
    while (joined_[zone] != zone) zone = joined_[zone];
    return zone;
  }

  std::vector<SealedRoom> rooms_;      // smallest first
  std::vector<std::uint32_t> zone_;    // by root
  std::vector<std::uint32_t> joined_;  // by zone: another one that light gets to from there, or itself
  std::vector<bool> is_lit_;           // by zone
};

/// Of the face's lowest corner along its normal.
double height_of(const RootPatch& face, Vec3 centre) {
  double height = dot(face.normal, face.corners[0] - centre);
  for (int c = 1; c < face.corner_count; ++c) height = std::min(height, dot(face.normal, face.corners[c] - centre));
  return height;
}

}  // namespace

LightReach::LightReach(const BaseMesh& mesh, const PointTree& corners) : is_dark(mesh.roots().size()) {
  const Zones zones(mesh);
  for (std::uint32_t root = 0; root < is_dark.size(); ++root) {
    const RootPatch& face = mesh.roots()[root];
    const double height = height_of(face, mesh.centre());
    const bool faces_nothing = !corners.any_above(face.normal, height + flat_tolerance * mesh.extent());
    const bool is_shut_off = !faces_nothing && !zones.may_be_lit(root);
    facing_nothing += faces_nothing;
    shut_off += is_shut_off;
    is_dark[root] = faces_nothing || is_shut_off;
  }
}

}  // namespace alvor
