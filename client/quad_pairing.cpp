#include "client/quad_pairing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <tuple>

namespace alvor {

namespace {

/// Below the base mesh's own limit of 1e-4, so that it does not cut the quads again.
constexpr double planar = 5e-5;
constexpr double max_corner_cosine = 0.9397;  // 20 degrees
/// Cost of triangles that do not follow each other, in thousandths of the worst corner's cosine.
constexpr int apart = 250;
/// More triangles than this at one edge are not all compared, which keeps the whole linear after the sort.
constexpr std::size_t max_compared = 4;

/// Edge `side` of a triangle runs from its corner `side` to the next; `low` and `high` are positions.
struct Edge {
  std::uint32_t low, high, face;
  std::uint8_t side;
  bool ascending;
};

struct Pairing {
  int cost;
  std::uint32_t first, second;  ///< faces, first < second
  std::array<std::uint32_t, 4> corners;
};

/// The lowest vertex at the same place, for each vertex.
std::vector<std::uint32_t> same_places(std::span<const Vec3> vertices) {
  const auto key = [&](std::uint32_t v) { return std::tuple(vertices[v].x, vertices[v].y, vertices[v].z); };
  std::vector<std::uint32_t> order(vertices.size()), place(vertices.size());
  std::iota(order.begin(), order.end(), 0u);
  std::ranges::sort(order, [&](std::uint32_t a, std::uint32_t b) { return std::pair(key(a), a) < std::pair(key(b), b); });
  for (std::size_t i = 0; i < order.size(); ++i)
    place[order[i]] = i > 0 && vertices[order[i]] == vertices[order[i - 1]] ? place[order[i - 1]] : order[i];
  return place;
}

void add_edges(const Scene& scene, std::uint32_t face, std::span<const std::uint32_t> place, std::vector<Edge>& edges) {
  const auto corners = scene.corners_of(scene.faces[face]);
  for (std::uint8_t side = 0; side < 3; ++side) {
    const std::uint32_t from = place[corners[side]], to = place[corners[(side + 1) % 3]];
    edges.push_back({std::min(from, to), std::max(from, to), face, side, from < to});
  }
}

/// Edges of all triangles; those between the same places are neighbours, in the order of their faces.
std::vector<Edge> sorted_edges(const Scene& scene) {
  const std::vector<std::uint32_t> place = same_places(scene.vertices);
  std::vector<Edge> edges;
  for (std::uint32_t f = 0; f < scene.faces.size(); ++f)
    if (scene.faces[f].corner_count == 3) add_edges(scene, f, place, edges);
  std::ranges::sort(edges, {}, [](const Edge& e) { return std::tuple(e.low, e.high, e.face, e.side); });
  return edges;
}

/// The outline of both triangles, from the first corner of `a`'s triangle on.
std::array<std::uint32_t, 4> outline(const Scene& scene, const Edge& a, const Edge& b) {
  const auto t = scene.corners_of(scene.faces[a.face]), s = scene.corners_of(scene.faces[b.face]);
  const std::uint32_t opposite = s[(b.side + 2) % 3];
  if (a.side == 0) return {t[0], opposite, t[1], t[2]};
  if (a.side == 1) return {t[0], t[1], opposite, t[2]};
  return {t[0], t[1], t[2], opposite};
}

/// The largest |cosine| of a corner: 0 for a rectangle. Nothing unless planar and strictly convex.
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

std::optional<Pairing> pairing_of(const Scene& scene, const Edge& a, const Edge& b) {
  if (a.face == b.face || a.ascending == b.ascending) return std::nullopt;
  if (scene.faces[a.face].material != scene.faces[b.face].material) return std::nullopt;
  const auto corners = outline(scene, a, b);
  const std::array<Vec3, 4> points{scene.vertices[corners[0]], scene.vertices[corners[1]], scene.vertices[corners[2]],
                                   scene.vertices[corners[3]]};
  const std::optional<double> cosine = worst_corner(points);
  if (!cosine || *cosine > max_corner_cosine) return std::nullopt;
  // In whole thousandths, so that rounding does not decide between equal squares.
  const int cost = static_cast<int>(std::lround(*cosine * 1000)) + (b.face - a.face == 1 ? 0 : apart);
  return Pairing{cost, a.face, b.face, corners};
}

std::vector<Pairing> best_pairings_first(const Scene& scene) {
  const std::vector<Edge> edges = sorted_edges(scene);
  std::vector<Pairing> pairings;
  for (std::size_t i = 0; i < edges.size(); ++i)
    for (std::size_t j = i + 1; j < edges.size() && j <= i + max_compared; ++j) {
      if (edges[i].low != edges[j].low || edges[i].high != edges[j].high) break;
      if (const auto pairing = pairing_of(scene, edges[i], edges[j])) pairings.push_back(*pairing);
    }
  std::ranges::sort(pairings, {}, [](const Pairing& p) { return std::tuple(p.cost, p.first, p.second); });
  return pairings;
}

/// Which pairing each face belongs to; `unpaired` if none.
constexpr std::uint32_t unpaired = ~0u;
std::vector<std::uint32_t> choose(std::span<const Pairing> pairings, std::size_t face_count) {
  std::vector<std::uint32_t> chosen(face_count, unpaired);
  for (std::uint32_t p = 0; p < pairings.size(); ++p)
    if (chosen[pairings[p].first] == unpaired && chosen[pairings[p].second] == unpaired)
      chosen[pairings[p].first] = chosen[pairings[p].second] = p;
  return chosen;
}

}  // namespace

void pair_triangles(Scene& scene) {
  const std::vector<Pairing> pairings = best_pairings_first(scene);
  const std::vector<std::uint32_t> chosen = choose(pairings, scene.faces.size());
  Scene paired;
  for (std::uint32_t f = 0; f < scene.faces.size(); ++f) {
    if (chosen[f] == unpaired) paired.add_face(scene.corners_of(scene.faces[f]), scene.faces[f].material);
    else if (pairings[chosen[f]].first == f) paired.add_face(pairings[chosen[f]].corners, scene.faces[f].material);
  }
  scene.corners = std::move(paired.corners);
  scene.faces = std::move(paired.faces);
}

}  // namespace alvor
