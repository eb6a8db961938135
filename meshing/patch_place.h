#pragma once
// The place of a patch on its root, in exact integer coordinates: neighbours agree on shared vertices to the bit.

#include "meshing/base_mesh.h"
#include "solution/patch_id.h"

#include <array>
#include <cstdint>
#include <optional>

namespace alvor {

/// A point of a root patch on the finest grid: u = i / grid_size, v = j / grid_size.
struct GridPoint {
  std::int32_t i = 0, j = 0;
  friend bool operator==(const GridPoint&, const GridPoint&) = default;
};
inline constexpr std::int32_t grid_size = 1 << PatchId::max_level;

/// Returns the bits of x at even positions, next to each other: u of a path in Morton order, and v of one shifted right by one.
constexpr std::uint32_t gathered_bits(std::uint32_t x) {
  x &= 0x55555555u;
  x = (x | (x >> 1)) & 0x33333333u;
  x = (x | (x >> 2)) & 0x0f0f0f0fu;
  x = (x | (x >> 4)) & 0x00ff00ffu;
  return (x | (x >> 8)) & 0x0000ffffu;
}

struct Uv {
  double u = 0, v = 0;
};

/// Returns a uniform point of a face with so many corners for a uniform point of the unit square.
inline Uv on_face(int corner_count, Uv at) { return corner_count == 3 && at.u + at.v > 1 ? Uv{1 - at.u, 1 - at.v} : at; }

/// The place of a patch on its root's grid. Quads split at their centre: child k lies at u half k & 1, v half k >> 1; or into
/// slabs: child k is the k-th along the axis. Triangles split at their edge midpoints: children 0..2 keep corners 0..2, child 3
/// is the inner one, turned by 180 degrees (sizes < 0).
struct PatchShape {
  std::uint32_t root = 0;
  int corner_count = 3;
  GridPoint first;                      ///< the patch's corner 0
  std::int32_t size_u = 0, size_v = 0;  ///< lengths of its edges in grid steps; equal, and negative if turned, for a triangle
  /// Number of strata of a quad along u: 1, 2, 4, 8 or 16. Quads of long roots have more along their long side, so that a leaf
  /// 4 mm wide and 28 cm long is looked at every 2 cm. A slab of a quad with 4 x 4 strata has
  /// 4 x 4; cut across its long side, slabs of a longer quad have half as many along it.
  std::int32_t strata_along_u = 4;

  std::array<GridPoint, 4> corners() const;
  Uv centre() const;
  /// Returns the middle of stratum `o`. Strata 4 k to 4 k + 3 form quarter k. The strata of a triangle, and of a quad with four
  /// along u, are the patch's grandchildren; its quarters are its children. Requires: 0 <= o < strata_per_patch.
  Uv stratum_centre(int o) const;
  /// Returns the middle of quarter `k`: the mean of its strata's middles.
  Uv quarter_centre(int k) const;
  PatchShape child(int k, Split how = Split::quarters) const;
  /// Returns the length of an edge in grid steps.
  std::int32_t size_along(int edge) const;
  /// Returns the shape of a whole root with so many corners.
  static PatchShape whole(std::uint32_t root, int corner_count, std::int32_t strata_along_u = 4) {
    return {root, corner_count, {0, 0}, grid_size, grid_size, strata_along_u};
  }

 private:
  Uv inside(Uv at) const;
  Uv long_way(Uv along) const;
};

PatchShape shape_of(const BaseMesh& mesh, PatchId patch);
/// Returns the corner positions, metres; corners[3] is unused for a triangle.
std::array<Vec3, 4> corners_of(const BaseMesh& mesh, const PatchShape& shape);
double area_of(const BaseMesh& mesh, const PatchShape& shape);
Vec3 centre_of(const BaseMesh& mesh, const PatchShape& shape);

/// Sets `path` to the path (see PatchId::finest) of the finest patch that contains each (u, v). Coordinates outside the root are
/// clamped into it. Each call converts `places_at_once` points, the number of rays in a packet.
inline constexpr int places_at_once = 16;
void finest_quad_paths(const float* u, const float* v, std::uint32_t* path);
void finest_triangle_paths(const float* u, const float* v, std::uint32_t* path);

/// Returns the finest patch that contains a point of a root. Coordinates outside the root are clamped into it.
PatchId finest_patch(const BaseMesh& mesh, std::uint32_t root, Uv at);

/// Returns the patch in the same place on the other side: on the twin of its root. Requires: its root has a twin.
PatchId twin_of(const BaseMesh& mesh, PatchId patch);

/// Returns the root edge on which the patch's edge lies, or nothing if it lies inside the root.
std::optional<int> root_edge_of(const PatchShape& shape, int edge);

/// Returns the finest patch just across `edge`, at `fraction` of the way along it, or nothing where the surface ends.
std::optional<PatchId> place_across(const BaseMesh& mesh, const PatchShape& shape, int edge, double fraction);

}  // namespace alvor
