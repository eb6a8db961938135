#include "meshing/quad_pairing.h"

#include "meshing/polygon.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <optional>
#include <tuple>

namespace alvor {

namespace {

constexpr double planar = 4e-6;               // the tolerance up to which meshing/polygon.h keeps quads whole
constexpr double max_corner_cosine = 0.9397;  // 20 degrees
/// Extra cost of a pair of triangles that do not follow each other in the file, in thousandths (the unit of the worst corner's
/// cosine).
constexpr int apart = 250;
/// At most this many triangles at one edge are compared, so that the time after sorting stays linear.
constexpr std::size_t max_compared = 4;

/// Edge `side` of a triangle runs from its corner `side` to the next; `low` and `high` are its vertices.
struct Edge {
  std::uint32_t low, high, triangle;
  std::uint8_t side;
  bool ascending;
};

struct Pairing {
  int cost;
  TrianglePair pair;
};

/// Returns the edges of all triangles, sorted so that edges between the same vertices are adjacent, in the order of their
/// triangles.
std::vector<Edge> sorted_edges(std::span<const PairableTriangle> triangles) {
  std::vector<Edge> edges;
  edges.reserve(3 * triangles.size());
  for (std::uint32_t t = 0; t < triangles.size(); ++t)
    for (std::uint8_t side = 0; side < 3; ++side) {
      const std::uint32_t from = triangles[t].corners[side], to = triangles[t].corners[(side + 1) % 3];
      edges.push_back({std::min(from, to), std::max(from, to), t, side, from < to});
    }
  std::ranges::sort(edges, {}, [](const Edge& e) { return std::tuple(e.low, e.high, e.triangle, e.side); });
  return edges;
}

/// Returns the outline of both triangles, starting at the first corner of `a`'s triangle.
std::array<std::uint32_t, 4> outline(std::span<const PairableTriangle> triangles, const Edge& a, const Edge& b) {
  const auto& t = triangles[a.triangle].corners;
  const std::uint32_t opposite = triangles[b.triangle].corners[(b.side + 2) % 3];
  if (a.side == 0) return {t[0], opposite, t[1], t[2]};
  if (a.side == 1) return {t[0], t[1], opposite, t[2]};
  return {t[0], t[1], t[2], opposite};
}

/// Returns the largest |cosine| of a corner angle: 0 for a rectangle. Returns nothing unless the quad is planar and strictly
/// convex.
std::optional<double> worst_corner(const std::array<Vec3, 4>& p) {
  const Vec3 area = cross(p[2] - p[0], p[3] - p[1]);
  const double size = std::max(length(p[2] - p[0]), length(p[3] - p[1]));
  if (!(length(area) > 0)) return std::nullopt;
  const Vec3 normal = normalized(area);
  if (!(std::abs(dot(p[1] - p[0], normal)) <= planar * size)) return std::nullopt;
  double worst = 0;
  for (int c = 0; c < 4; ++c) {
    const Vec3 in = p[c] - p[(c + 3) % 4], out = p[(c + 1) % 4] - p[c];
    if (!(dot(cross(in, out), normal) > 0)) return std::nullopt;
    worst = std::max(worst, std::abs(dot(in, out)) / (length(in) * length(out)));
  }
  return worst;
}

/// Chooses which triangles of one mesh to join.
class Pairer {
 public:
  Pairer(std::span<const PairableTriangle> triangles, std::span<const Vec3> positions)
      : triangles_(triangles), positions_(positions) {}

  std::vector<TrianglePair> pairs() const {
    std::vector<bool> is_used(triangles_.size());
    std::vector<TrianglePair> chosen;
    for (const Pairing& pairing : best_first()) {
      const TrianglePair& pair = pairing.pair;
      if (is_used[pair.first] || is_used[pair.second]) continue;
      is_used[pair.first] = is_used[pair.second] = true;
      chosen.push_back(pair);
    }
    return chosen;
  }

 private:
  std::optional<Pairing> pairing_of(const Edge& a, const Edge& b) const {
    const PairableTriangle &first = triangles_[a.triangle], &second = triangles_[b.triangle];
    if (a.triangle == b.triangle || a.ascending == b.ascending || first.material != second.material) return std::nullopt;
    const auto corners = outline(triangles_, a, b);
    const std::optional<double> cosine =
        worst_corner({positions_[corners[0]], positions_[corners[1]], positions_[corners[2]], positions_[corners[3]]});
    if (!cosine || *cosine > max_corner_cosine || is_cut_again(corners)) return std::nullopt;
    // Rounded to thousandths, so that rounding errors do not decide between equal squares.
    const int cost = static_cast<int>(std::lround(*cosine * 1000)) + (second.face - first.face == 1 ? 0 : apart);
    return Pairing{cost, {a.triangle, b.triangle, corners}};
  }

  bool is_cut_again(const std::array<std::uint32_t, 4>& corners) const {
    return pieces_of(std::array{positions_[corners[0]], positions_[corners[1]], positions_[corners[2]], positions_[corners[3]]})
               .size() > 1;
  }

  std::vector<Pairing> best_first() const {
    const std::vector<Edge> edges = sorted_edges(triangles_);
    std::vector<Pairing> pairings;
    for (std::size_t i = 0; i < edges.size(); ++i)
      for (std::size_t j = i + 1; j < edges.size() && j <= i + max_compared; ++j) {
        if (edges[i].low != edges[j].low || edges[i].high != edges[j].high) break;
        if (const auto pairing = pairing_of(edges[i], edges[j])) pairings.push_back(*pairing);
      }
    std::ranges::sort(pairings, {}, [](const Pairing& p) { return std::tuple(p.cost, p.pair.first, p.pair.second); });
    return pairings;
  }

  std::span<const PairableTriangle> triangles_;
  std::span<const Vec3> positions_;
};

}  // namespace

std::vector<TrianglePair> pair_triangles(std::span<const PairableTriangle> triangles, std::span<const Vec3> positions) {
  assert(std::ranges::is_sorted(triangles, {}, &PairableTriangle::face));
  assert(std::ranges::all_of(triangles, [&](const PairableTriangle& triangle) {
    const auto& [a, b, c] = triangle.corners;
    return a != b && b != c && c != a && std::max({a, b, c}) < positions.size();
  }));
  return Pairer(triangles, positions).pairs();
}

}  // namespace alvor
