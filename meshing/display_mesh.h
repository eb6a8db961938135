#pragma once
// What is drawn and written to files: triangles without cracks, values at vertices.

#include "meshing/base_mesh.h"
#include "solution/leaf_value.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace alvor {

/// Each triangle is (centre of a leaf, corner, next corner), counter-clockwise: the side opposite its first vertex lies on the
/// leaf's outline. Vertices are shared only where the surface is smooth and the material the same.
struct DisplayMesh {
  std::vector<Vec3> positions;   ///< metres
  std::vector<Vec3> normals;     ///< unit, of the front
  std::vector<RgbF> irradiance;  ///< H, W/m2
  std::vector<RgbF> radiosity;   ///< B = E + rho H, W/m2
  std::vector<std::array<std::uint32_t, 3>> triangles;
  UpAxis up = UpAxis::y;
};

/// Triangulates `leaves` (sorted by id, together covering every root of `mesh`), with a vertex at every hanging corner so that no
/// crack opens. A corner's irradiance is extrapolated linearly from each smooth neighbour and averaged, clamped to the range of
/// the neighbours' values; never across a crease, and leaves where exactly nothing arrives take no part. The two sides of a
/// two-sided face lie 4e-5 of the extent apart, so that whatever draws the mesh can tell which is in front.
DisplayMesh build_display_mesh(const BaseMesh& mesh, std::span<const LeafValue> leaves);

}  // namespace alvor
