#pragma once
// Cameras and the choice of a default view.

#include "meshing/display_mesh.h"

namespace alvor {

class TriangleCaster;

/// A perspective camera and the size of its picture. Requires: eye != target, `up` not along the view, 0 < fov < 180.
struct Camera {
  Vec3 eye;
  Vec3 target;
  Vec3 up{0, 1, 0};
  double vertical_fov_degrees = 40;
  int width = 1024;  ///< pixels
  int height = 768;
};

/// The rays through the pixels of a camera. Pixel coordinates run right and down from the picture's upper left corner.
class Viewfinder {
 public:
  explicit Viewfinder(const Camera& camera);
  Vec3 eye() const { return eye_; }
  /// Returns the unit direction through (x, y); the middle of the first pixel is (0.5, 0.5).
  Vec3 direction(double x, double y) const;

 private:
  Vec3 eye_, corner_, right_, down_;  ///< corner_ is the direction at (0, 0); right_ and down_ are steps of one pixel
};

/// A picture's size in pixels.
struct PictureSize {
  int width = 1024;
  int height = 768;
};

/// Returns a view that shows the fronts of surfaces with the mesh's up axis upright: through the open side of a room, as the
/// Cornell box is shown; from a corner of a closed room; from outside and above for anything else. Requires:
/// !mesh.triangles.empty().
Camera default_camera(const DisplayMesh& mesh, PictureSize size = {});
/// Returns the default view, using a caster that the caller has already built for the same mesh.
Camera default_camera(const DisplayMesh& mesh, const TriangleCaster& caster, PictureSize size);

}  // namespace alvor
