#pragma once
// Cuts a triangle mesh into charts, pieces that are laid flat without overlap.

#include "meshing/vec3.h"

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace alvor {

using MeshTriangle = std::array<std::uint32_t, 3>;

/// A piece of a mesh and the plane onto which it is projected.
struct Chart {
  Vec3 u, v;                             ///< unit, orthogonal; u x v points to the front
  double low_u = 0, low_v = 0;           ///< lower corner of the box about the projected piece, in units of the mesh
  double wide = 0, high = 0;             ///< sides of that box
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

  /// Returns whether vertices are those of the mesh, so that what it says of them may be shared.
  bool keeps_vertices(std::size_t count) const;
};

/// Cuts a mesh. A chart grows over common edges from its largest triangle, to triangles whose normals lie within 45 degrees of that
/// one's, so none is turned over and the projection shrinks none by more than 1 / sqrt(2). Where the projection of a chart
/// overlaps itself, as that of a spiral ramp does, its triangles become charts of flat faces. Requires: indices are in range.
ChartedMesh cut_into_charts(std::span<const Vec3> positions, std::span<const MeshTriangle> triangles);

/// Returns a point projected onto a chart's plane, relative to the lower corner of its box.
inline std::array<double, 2> on_chart(const Chart& chart, const Vec3& at) {
  return {dot(chart.u, at) - chart.low_u, dot(chart.v, at) - chart.low_v};
}

}  // namespace alvor
