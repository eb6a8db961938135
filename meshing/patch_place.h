#pragma once
// Where a patch lies on its root: exact integer coordinates, so that neighbours agree on shared vertices to the bit.

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

struct Uv {
  double u = 0, v = 0;
};

/// A patch on its root's grid. Quads split at their centre: child k lies at u half k & 1, v half k >> 1. Triangles split at their
/// edge midpoints: children 0..2 keep corners 0..2, child 3 is the inner one, turned by half a circle (size < 0).
struct PatchShape {
  std::uint32_t root = 0;
  int corner_count = 3;
  GridPoint first;        ///< corner 0
  std::int32_t size = 0;  ///< edge on the grid; negative for a turned triangle

  std::array<GridPoint, 4> corners() const;
  Uv centre() const;
  PatchShape child(int k) const;
};

PatchShape shape_of(const BaseMesh& mesh, PatchId patch);
/// Corner positions in the mesh's units; corners[3] unused for a triangle.
std::array<Vec3, 4> corners_of(const BaseMesh& mesh, const PatchShape& shape);
double area_of(const BaseMesh& mesh, const PatchShape& shape);
Vec3 centre_of(const BaseMesh& mesh, const PatchShape& shape);

/// Paths (see PatchId::finest) of the finest patches that contain each (u, v); coordinates outside the root are clamped into it.
/// Sixteen at a time because rays come so.
inline constexpr int places_at_once = 16;
void finest_quad_paths(const float* u, const float* v, std::uint32_t* path);
void finest_triangle_paths(const float* u, const float* v, std::uint32_t* path);

/// The finest patch that contains a point; coordinates outside the root are clamped into it.
PatchId finest_patch(const BaseMesh& mesh, std::uint32_t root, Uv at);

/// The root edge on which the patch's edge lies, if any.
std::optional<int> root_edge_of(const PatchShape& shape, int edge);

/// The finest patch just across `edge` of the patch, at `fraction` of the way along it; nothing where the surface ends.
std::optional<PatchId> place_across(const BaseMesh& mesh, const PatchShape& shape, int edge, double fraction);

}  // namespace alvor
