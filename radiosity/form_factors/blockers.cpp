#include "radiosity/form_factors/blockers.h"

#include <cmath>
#include <map>
#include <optional>
#include <utility>

namespace alvor {

namespace {

// Most corners of two polygons together that are joined; cutting a polygon adds corners, of which ConvexPolygon holds 80. Chosen;
// half and double give the same solutions (docs/design/constants.md).
constexpr std::size_t most_corners = 32;
// Sine of the angle between the normals of polygons that count as coplanar. Chosen; half and double give the same solutions
// (docs/design/constants.md).
constexpr double same_plane = 1e-9;
// Sine of the angle at a corner that counts as straight and is dropped. Chosen; half and double give the same solutions
// (docs/design/constants.md).
constexpr double straight = 1e-9;

/// A polygon as the list of its welded vertices. Empty after it was joined to another.
using Corners = std::vector<std::uint32_t>;
struct Ring : Corners {
  std::uint32_t root = 0;
};

/// Joins neighbouring coplanar polygons into convex ones.
class Joining {
 public:
  Joining(const BaseMesh& mesh, const std::function<bool(std::uint32_t root)>& counts) {
    for (std::uint32_t r = 0; r < mesh.roots().size(); ++r) {
      const RootPatch& root = mesh.roots()[r];
      if (root.is_back || !counts(r)) continue;
      Ring ring;
      ring.root = r;
      for (int c = 0; c < root.corner_count; ++c) {
        position_.emplace(root.vertex[c], root.corners[c]);
        ring.push_back(root.vertex[c]);
      }
      rings_.push_back(ring);
    }
  }

  std::vector<Ring> join() {
    while (join_pairs() > 0) std::erase_if(rings_, [](const Ring& ring) { return ring.empty(); });
    return std::move(rings_);
  }
  Vec3 at(std::uint32_t vertex) const { return position_.at(vertex); }

 private:
  Vec3 normal(const Ring& ring) const {
    std::vector<Vec3> corners;
    for (const std::uint32_t v : ring) corners.push_back(at(v));
    return normalized(area_vector(corners));
  }

  /// Joins each polygon to one neighbour at most, so that they grow evenly.
  std::size_t join_pairs() {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> by_edge;
    for (std::size_t r = 0; r < rings_.size(); ++r)
      for (std::size_t c = 0; c < rings_[r].size(); ++c) by_edge[{rings_[r][c], rings_[r][(c + 1) % rings_[r].size()]}] = r;
    std::vector<bool> has_joined(rings_.size());
    std::size_t joined = 0;
    for (std::size_t r = 0; r < rings_.size(); ++r)
      for (std::size_t c = 0; c < rings_[r].size() && !has_joined[r]; ++c) {
        const auto across = by_edge.find({rings_[r][(c + 1) % rings_[r].size()], rings_[r][c]});
        if (across == by_edge.end() || across->second == r || has_joined[across->second]) continue;
        if (auto both = union_of(rings_[r], c, rings_[across->second])) {
          has_joined[r] = has_joined[across->second] = true;
          rings_[across->second].clear();
          rings_[r] = std::move(*both);
          ++joined;
        }
      }
    return joined;
  }

  /// Returns the union of two polygons; nothing if they are not in one plane or not convex together. Requires: edge c of `a` is
  /// an edge of `b`, in the opposite direction.
  std::optional<Ring> union_of(const Ring& a, std::size_t c, const Ring& b) const {
    if (a.size() + b.size() > most_corners || length(cross(normal(a), normal(b))) > same_plane) return std::nullopt;
    if (dot(normal(a), normal(b)) < 0) return std::nullopt;
    const std::size_t start = static_cast<std::size_t>(std::ranges::find(b, a[c]) - b.begin());
    Ring both;
    both.root = a.root;
    for (std::size_t k = 0; k < a.size(); ++k) both.push_back(a[(c + 1 + k) % a.size()]);
    for (std::size_t k = 1; k + 1 < b.size(); ++k) both.push_back(b[(start + k) % b.size()]);
    drop_straight_corners(both);
    std::vector<Vec3> corners;
    for (const std::uint32_t v : both) corners.push_back(at(v));
    if (both.size() < 3 || !is_convex(corners)) return std::nullopt;
    return both;
  }

  void drop_straight_corners(Ring& ring) const {
    for (std::size_t c = 0; c < ring.size() && ring.size() > 3;) {
      const Vec3 before = at(ring[(c + ring.size() - 1) % ring.size()]), here = at(ring[c]),
                 next = at(ring[(c + 1) % ring.size()]);
      const Vec3 in = here - before, out = next - here;
      if (length(cross(in, out)) <= straight * length(in) * length(out) && dot(in, out) > 0)
        ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(c));
      else ++c;
    }
  }

  std::vector<Ring> rings_;
  std::map<std::uint32_t, Vec3> position_;
};

}  // namespace

Box Box::of(std::span<const Vec3> points) {
  Box box{points[0], points[0]};
  for (const Vec3& p : points) box = box.joined({p, p});
  return box;
}

Box Box::joined(const Box& o) const { return {lower(low, o.low), upper(high, o.high)}; }

bool Box::touches(const Box& o) const {
  return low.x <= o.high.x && o.low.x <= high.x && low.y <= o.high.y && o.low.y <= high.y && low.z <= o.high.z &&
         o.low.z <= high.z;
}

std::vector<JoinedFace> joined_faces(const BaseMesh& mesh, const std::function<bool(std::uint32_t root)>& counts) {
  Joining joining(mesh, counts);
  std::vector<JoinedFace> faces;
  for (const Ring& ring : joining.join()) {
    JoinedFace& face = faces.emplace_back();
    face.root = ring.root;
    for (const std::uint32_t v : ring) face.corners.push_back(joining.at(v));
  }
  return faces;
}

Blockers::Blockers(const BaseMesh& mesh) {
  for (const JoinedFace& face : joined_faces(mesh)) {
    polygons_.emplace_back(face.corners);
    boxes_.push_back(Box::of(polygons_.back().corners()));
  }
}

void Blockers::find_in(const Box& box, std::vector<const ConvexPolygon*>& found) const {
  found.clear();
  for (std::size_t n = 0; n < boxes_.size(); ++n)
    if (boxes_[n].touches(box)) found.push_back(&polygons_[n]);
}

}  // namespace alvor
