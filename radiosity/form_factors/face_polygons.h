#pragma once
// The faces of a scene as convex planar polygons.

#include "meshing/base_mesh.h"
#include "radiosity/form_factors/convex_polygon.h"

#include <vector>

namespace alvor {

/// The fronts of a scene's faces, each as one or more convex planar polygons (pieces). A convex face of up to 64 corners is one
/// piece; others are the pieces that the base mesh cut them into. Numbered as in the scene; degenerate and duplicate faces have
/// no pieces.
class FacePolygons {
 public:
  /// Requires: `mesh` was built from `scene` without joining triangles, so that each root comes from one face.
  FacePolygons(const Scene& scene, const BaseMesh& mesh);
  /// Makes a face of each polygon. Requires: planar and convex polygons.
  explicit FacePolygons(std::vector<std::vector<Vec3>> polygons);

  std::size_t face_count() const { return pieces_.size(); }
  const std::vector<std::vector<Vec3>>& pieces(std::uint32_t face) const { return pieces_[face]; }
  double area(std::uint32_t face) const { return area_[face]; }

 private:
  std::vector<std::vector<std::vector<Vec3>>> pieces_;
  std::vector<double> area_;
};

}  // namespace alvor
