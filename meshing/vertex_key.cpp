#include "meshing/vertex_key.h"

#include "meshing/disjoint_sets.h"

namespace alvor {

namespace {

// The upper two bits distinguish keys of corners, edges and interior points.
VertexKey corner_key(std::uint32_t owner) { return owner; }
VertexKey edge_key(std::uint32_t root, int edge, std::int32_t along) {
  return VertexKey{1} << 62 | VertexKey{root} << 20 | VertexKey(edge) << 16 | VertexKey(along);
}
VertexKey inner_key(std::uint32_t root, GridPoint p) {
  return VertexKey{2} << 62 | VertexKey{root} << 30 | VertexKey(p.i) << 15 | VertexKey(p.j);
}

std::optional<int> corner_at(int corner_count, GridPoint p) {
  const PatchShape whole = PatchShape::whole(0, corner_count);
  const auto corners = whole.corners();
  for (int c = 0; c < corner_count; ++c)
    if (corners[c] == p) return c;
  return std::nullopt;
}

struct EdgePoint {
  int edge;
  std::int32_t along;
};
std::optional<EdgePoint> edge_at(int corner_count, GridPoint p) {
  if (p.j == 0) return EdgePoint{0, p.i};
  if (corner_count == 4) {
    if (p.i == grid_size) return EdgePoint{1, p.j};
    if (p.j == grid_size) return EdgePoint{2, grid_size - p.i};
    if (p.i == 0) return EdgePoint{3, grid_size - p.j};
    return std::nullopt;
  }
  if (p.i + p.j == grid_size) return EdgePoint{1, p.j};
  if (p.i == 0) return EdgePoint{2, grid_size - p.j};
  return std::nullopt;
}

}  // namespace

VertexKeys::VertexKeys(const BaseMesh& mesh)
    : mesh_(mesh), position_(find_owners(mesh, true)), smooth_(find_owners(mesh, false)) {}

VertexKeys::Owners VertexKeys::find_owners(const BaseMesh& mesh, bool across_creases) {
  const auto roots = static_cast<std::uint32_t>(mesh.roots().size());
  Owners owners{std::vector<std::array<Owners::Edge, 4>>(roots), std::vector<std::array<std::uint32_t, 4>>(roots)};
  DisjointSets corners(4 * std::size_t{roots});  // numbered 4 root + corner; those in one set are the same vertex
  for (std::uint32_t root = 0; root < roots; ++root) {
    const int n = mesh.roots()[root].corner_count;
    for (int e = 0; e < n; ++e) {
      owners.edge[root][e] = {root, e, false};
      const auto other = mesh.across(root, e);
      if (!other || !(other->smooth || across_creases)) continue;
      if (other->root < root) owners.edge[root][e] = {other->root, other->edge, true};
      const int there = mesh.roots()[other->root].corner_count;
      corners.join(4 * root + e, 4 * other->root + (other->edge + 1) % there);
      corners.join(4 * root + (e + 1) % n, 4 * other->root + other->edge);
    }
  }
  for (std::uint32_t root = 0; root < roots; ++root)
    for (int c = 0; c < mesh.roots()[root].corner_count; ++c) owners.corner[root][c] = corners.find(4 * root + c);
  return owners;
}

VertexKey VertexKeys::key(const Owners& owners, std::uint32_t root, GridPoint p) const {
  const int n = mesh_.roots()[root].corner_count;
  if (const auto corner = corner_at(n, p)) return corner_key(owners.corner[root][*corner]);
  if (const auto at = edge_at(n, p)) {
    const auto& owner = owners.edge[root][at->edge];
    return edge_key(owner.root, owner.edge, owner.reversed ? grid_size - at->along : at->along);
  }
  return inner_key(root, p);
}

}  // namespace alvor
