#include "meshing/patch_place.h"

#include <algorithm>
#include <cstdlib>

namespace alvor {

namespace {

/// Returns the low 16 bits of x spread to the even bit positions (Morton order).
constexpr std::uint32_t spread_bits(std::uint32_t x) {
  x = (x | (x << 8)) & 0x00ff00ffu;
  x = (x | (x << 4)) & 0x0f0f0f0fu;
  x = (x | (x << 2)) & 0x33333333u;
  return (x | (x << 1)) & 0x55555555u;
}

/// Returns x clamped to [0, most], and a number in it for NaN (unlike std::clamp): lanes whose ray hit nothing hold any bits.
float bounded(float x, float most) { return std::max(0.0f, std::min(x, most)); }

std::uint32_t quad_path(float u, float v) {
  const auto cell = [](float x) { return static_cast<std::int32_t>(bounded(x * grid_size, grid_size - 1.0f)); };
  return spread_bits(static_cast<std::uint32_t>(cell(u))) | spread_bits(static_cast<std::uint32_t>(cell(v))) << 1;
}

/// Finds the paths of `count` points at once. Walks down in coordinates relative to the current triangle, in 30-bit fixed point
/// with a + b < 1; entering the inner child reverses both axes. Has no branches and goes level by level for all points, so that
/// the compiler vectorises it.
template <int count>
void triangle_paths(const float* us, const float* vs, std::uint32_t* path) {
  constexpr std::uint32_t one = 1u << 30;
  constexpr auto just_below_one = static_cast<float>(one - 256);  // float rounding stays within the 256
  alignas(64) std::uint32_t as[count], bs[count], paths[count];
  for (int n = 0; n < count; ++n) {
    const float u = bounded(us[n], 1), v = bounded(vs[n], 1);
    const float excess = std::max(0.0f, u + v - 1) / 2;
    as[n] = static_cast<std::uint32_t>(static_cast<std::int32_t>((u - excess) * just_below_one));
    bs[n] = static_cast<std::uint32_t>(static_cast<std::int32_t>((v - excess) * just_below_one));
    paths[n] = 0;
  }
  for (int level = 0; level < PatchId::max_level; ++level)
    for (int n = 0; n < count; ++n) {
      std::uint32_t a = as[n] << 1, b = bs[n] << 1;
      const std::uint32_t at_u = a >> 30, at_v = b >> 30;  // past the midpoint: children 1 and 2
      a &= one - 1, b &= one - 1;
      const std::uint32_t inner = ((one - a - b) >> 31) & ~(at_u | at_v) & 1u, turn = 0u - inner;
      as[n] = (a ^ turn) - turn + (one & turn);
      bs[n] = (b ^ turn) - turn + (one & turn);
      paths[n] = paths[n] << 2 | at_u | at_v << 1 | (turn & 3u);
    }
  std::copy_n(paths, count, path);
}

/// Returns the point at `fraction` of root edge `edge`, moved into the root by `inwards` grid units.
Uv on_root_edge(int corner_count, int edge, double fraction, double inwards) {
  const double d = inwards / grid_size;
  if (corner_count == 4) {
    switch (edge) {
      case 0: return {fraction, d};
      case 1: return {1 - d, fraction};
      case 2: return {1 - fraction, 1 - d};
      default: return {d, 1 - fraction};
    }
  }
  switch (edge) {
    case 0: return {fraction - d * fraction, d};
    case 1: return {(1 - d) * (1 - fraction), (1 - d) * fraction};
    default: return {d, (1 - fraction) - d * (1 - fraction)};
  }
}

bool on_edge(int corner_count, int edge, GridPoint p) {
  if (corner_count == 4) {
    const std::array<bool, 4> on{p.j == 0, p.i == grid_size, p.j == grid_size, p.i == 0};
    return on[edge];
  }
  const std::array<bool, 3> on{p.j == 0, p.i + p.j == grid_size, p.i == 0};
  return on[edge];
}

/// Returns how far along the root edge the point lies, from 0 at the edge's start to 1.
double along_root_edge(int corner_count, int edge, Uv p) {
  if (corner_count == 4) return std::array<double, 4>{p.u, p.v, 1 - p.u, 1 - p.v}[edge];
  return std::array<double, 3>{p.u, p.v, 1 - p.v}[edge];
}

}  // namespace

std::array<GridPoint, 4> PatchShape::corners() const {
  const auto [i, j] = first;
  if (corner_count == 4) return {{{i, j}, {i + size_u, j}, {i + size_u, j + size_v}, {i, j + size_v}}};
  return {{{i, j}, {i + size_u, j}, {i, j + size_v}, {}}};
}

Uv PatchShape::centre() const {
  if (corner_count == 4) return inside({0.5, 0.5});
  return {(first.i + size_u / 3.0) / grid_size, (first.j + size_v / 3.0) / grid_size};
}

Uv PatchShape::stratum_centre(int o) const {
  const int k = o >> 2, within = o & 3;
  if (corner_count == 3) return child(k).child(within).centre();
  if (strata_along_u == 4) return inside({(2 * (k & 1) + (within & 1) + 0.5) / 4, (2 * (k >> 1) + (within >> 1) + 0.5) / 4});
  const bool is_row = strata_along_u == 16 || strata_along_u == 1;
  return long_way(is_row ? Uv{(o + 0.5) / 16, 0.5} : Uv{(2 * k + (within & 1) + 0.5) / 8, ((within >> 1) + 0.5) / 2});
}

Uv PatchShape::quarter_centre(int k) const {
  if (corner_count == 3) return child(k).centre();
  if (strata_along_u == 4) return inside({((k & 1) + 0.5) / 2, ((k >> 1) + 0.5) / 2});
  return long_way({(k + 0.5) / 4, 0.5});
}

/// Returns the place in the root of a point of the unit square.
Uv PatchShape::inside(Uv at) const { return {(first.i + size_u * at.u) / grid_size, (first.j + size_v * at.v) / grid_size}; }

/// Returns the place in the root of a point of the unit square that is given along the side with more strata and across it.
Uv PatchShape::long_way(Uv along) const { return inside(strata_along_u > 4 ? along : Uv{along.v, along.u}); }

PatchShape PatchShape::child(int k, Split how) const {
  PatchShape c = *this;
  if (how == Split::slabs_along_u) {
    c.size_u = size_u / 4;
    c.first.i += k * c.size_u;
    if (strata_along_u > 4) c.strata_along_u /= 2;
    return c;
  }
  if (how == Split::slabs_along_v) {
    c.size_v = size_v / 4;
    c.first.j += k * c.size_v;
    if (strata_along_u < 4) c.strata_along_u *= 2;
    return c;
  }
  const std::int32_t h = size_u / 2, w = size_v / 2;
  c.size_u = h, c.size_v = w;
  if (corner_count == 4) {
    c.first = {first.i + (k & 1) * h, first.j + (k >> 1) * w};
  } else if (k == 3) {
    c.first = {first.i + h, first.j + h};
    c.size_u = c.size_v = -h;
  } else {
    c.first = {first.i + (k == 1 ? h : 0), first.j + (k == 2 ? h : 0)};
  }
  return c;
}

std::int32_t PatchShape::size_along(int edge) const { return std::abs(corner_count == 3 || edge % 2 == 0 ? size_u : size_v); }

PatchShape shape_of(const BaseMesh& mesh, PatchId patch) {
  const RootPatch& root = mesh.roots()[patch.root_face()];
  PatchShape shape = PatchShape::whole(patch.root_face(), root.corner_count, root.strata_along_u);
  if (root.corner_count == 4 && !patch.has_slabs()) {
    const auto bits = static_cast<std::uint32_t>(patch.bits()), path = (bits & (bits - 1)) >> 1;  // without the lowest bit set
    shape.first = {static_cast<std::int32_t>(gathered_bits(path)), static_cast<std::int32_t>(gathered_bits(path >> 1))};
    shape.size_u = shape.size_v = grid_size >> patch.level();
    return shape;
  }
  for (int level = 1; level <= patch.level(); ++level) shape = shape.child(patch.child_index(level), patch.split_above(level));
  return shape;
}

std::array<Vec3, 4> corners_of(const BaseMesh& mesh, const PatchShape& shape) {
  const RootPatch& root = mesh.roots()[shape.root];
  const auto grid = shape.corners();
  std::array<Vec3, 4> at;
  for (int c = 0; c < shape.corner_count; ++c) at[c] = root.at(double(grid[c].i) / grid_size, double(grid[c].j) / grid_size);
  return at;
}

double area_of(const BaseMesh& mesh, const PatchShape& shape) {
  const auto p = corners_of(mesh, shape);
  if (shape.corner_count == 4) return 0.5 * length(cross(p[2] - p[0], p[3] - p[1]));
  return 0.5 * length(cross(p[1] - p[0], p[2] - p[0]));
}

Vec3 centre_of(const BaseMesh& mesh, const PatchShape& shape) {
  const Uv c = shape.centre();
  return mesh.roots()[shape.root].at(c.u, c.v);
}

void finest_quad_paths(const float* u, const float* v, std::uint32_t* path) {
  for (int n = 0; n < places_at_once; ++n) path[n] = quad_path(u[n], v[n]);
}

void finest_triangle_paths(const float* u, const float* v, std::uint32_t* path) { triangle_paths<places_at_once>(u, v, path); }

PatchId finest_patch(const BaseMesh& mesh, std::uint32_t root, Uv at) {
  const auto u = static_cast<float>(at.u), v = static_cast<float>(at.v);
  if (mesh.roots()[root].corner_count == 4) return PatchId::finest(root, quad_path(u, v));
  std::uint32_t path;
  triangle_paths<1>(&u, &v, &path);
  return PatchId::finest(root, path);
}

PatchId twin_of(const BaseMesh& mesh, PatchId patch) { return patch.mirrored(mesh.roots()[patch.root_face()].twin); }

std::optional<int> root_edge_of(const PatchShape& shape, int edge) {
  const auto corners = shape.corners();
  const GridPoint a = corners[edge], b = corners[(edge + 1) % shape.corner_count];
  for (int e = 0; e < shape.corner_count; ++e)
    if (on_edge(shape.corner_count, e, a) && on_edge(shape.corner_count, e, b)) return e;
  return std::nullopt;
}

std::optional<PatchId> place_across(const BaseMesh& mesh, const PatchShape& shape, int edge, double fraction) {
  constexpr double just = 0.25;  // fraction of a finest cell
  const auto corners = shape.corners();
  const GridPoint a = corners[edge], b = corners[(edge + 1) % shape.corner_count];
  const double i = a.i + fraction * (b.i - a.i), j = a.j + fraction * (b.j - a.j);
  if (const auto root_edge = root_edge_of(shape, edge)) {
    const auto neighbour = mesh.across(shape.root, *root_edge);
    if (!neighbour) return std::nullopt;
    const double along = along_root_edge(shape.corner_count, *root_edge, {i / grid_size, j / grid_size});
    const int there = mesh.roots()[neighbour->root].corner_count;
    return finest_patch(mesh, neighbour->root, on_root_edge(there, neighbour->edge, 1 - along, just));
  }
  if (shape.corner_count == 4) {
    constexpr std::array<Uv, 4> outwards{{{0, -just}, {just, 0}, {0, just}, {-just, 0}}};
    const auto out = outwards[static_cast<std::size_t>(edge)];
    return finest_patch(mesh, shape.root, {(i + out.u) / grid_size, (j + out.v) / grid_size});
  }
  const Uv c = shape.centre();
  const double di = i - c.u * grid_size, dj = j - c.v * grid_size;
  const double step = just / std::max({std::abs(di), std::abs(dj), 1e-9});
  return finest_patch(mesh, shape.root, {(i + step * di) / grid_size, (j + step * dj) / grid_size});
}

}  // namespace alvor
