#pragma once
// The triangles of a scene for the path tracer, made directly from the faces.

#include "meshing/scene.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace alvor {

/// One triangle of a face. Metres.
struct Facet {
  std::array<Vec3, 3> corners;                                     ///< counter-clockwise seen from the front
  Vec3 normal;                                                     ///< unit; points to the front
  double area = 0;                                                 ///< m2, > 0
  std::uint32_t face = 0;                                          ///< face of the scene
  std::array<RgbF, 3> colours{{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}};  ///< of the corners
  std::array<TexturePoint, 3> texture_points;                      ///< of the corners, if the face's material has a texture

  /// Returns the position (1-u-v) a + u b + v c.
  Vec3 at(double u, double v) const { return corners[0] + u * (corners[1] - corners[0]) + v * (corners[2] - corners[0]); }
};

/// Returns the triangles of all faces that have an area, in order. Nothing is welded. Requires: !find_fault(scene).
std::vector<Facet> facets_of(const Scene& scene);

/// The bounding box of points: its centre and longest side, metres.
struct Extent {
  Vec3 centre;
  double longest_side = 0;
};

/// Returns the bounding box of the facets' corners. Requires: !facets.empty().
Extent extent_of(std::span<const Facet> facets);
/// Returns the bounding box of the points. Requires: !points.empty().
Extent extent_of(std::span<const Vec3> points);

}  // namespace alvor
