#pragma once
// Cuts a triangle mesh into charts, pieces that are laid flat without overlap.

#include "meshing/vec3.h"

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace alvor {

using MeshTriangle = std::array<std::uint32_t, 3>;

/// A place on the plane of a chart, from the lower left corner of the box about the chart, in units of the mesh.
using FlatPoint = std::array<double, 2>;

/// A piece of a mesh that is laid flat.
struct Chart {
  /// The axes of the plane onto which it is projected: unit, orthogonal, u x v points to the front. Zero: it was laid flat by given
  /// coordinates.
  Vec3 u, v;
  double wide = 0, high = 0;             ///< sides of the box about it, in units of the mesh
  std::vector<std::uint32_t> triangles;  ///< of the mesh
};

/// A mesh cut into charts. Each vertex belongs to one chart: those that charts shared are there more than once.
struct ChartedMesh {
  static constexpr std::uint32_t no_chart = std::numeric_limits<std::uint32_t>::max();

  std::vector<Chart> charts;
  std::vector<std::uint32_t> chart_of;    ///< by triangle; no_chart: it has no area
  std::vector<std::uint32_t> source;      ///< by vertex: the vertex of the mesh that it copies
  std::vector<MeshTriangle> triangles;    ///< in the order of the mesh's, of the vertices above
  std::vector<std::uint32_t> vertex_chart;  ///< by vertex; no_chart as above
  std::vector<FlatPoint> flat;              ///< by vertex

  /// Returns whether vertices are those of the mesh, so that what it says of them may be shared.
  bool keeps_vertices(std::size_t count) const;
};

/// Cuts a mesh. A chart grows over common edges from its largest triangle, to triangles whose normals lie within 45 degrees of that
/// one's, so none is turned over and the projection shrinks none by more than 1 / sqrt(2). Where the projection of a chart
/// overlaps itself, as that of a spiral ramp does, its triangles become charts of flat faces. Requires: indices are in range.
ChartedMesh cut_into_charts(std::span<const Vec3> positions, std::span<const MeshTriangle> triangles);

/// Makes one chart of a mesh by texture coordinates that it has: those of its vertices, (0, 0) the upper left corner, as large as
/// the mesh's area. Nothing if they overlap, or a triangle has no area there, or they are not finite. Requires: indices are in
/// range; one point for each position.
std::optional<ChartedMesh> chart_of_points(std::span<const Vec3> positions, std::span<const MeshTriangle> triangles,
                                           std::span<const std::array<float, 2>> points);

}  // namespace alvor
