#pragma once
// Pictures of a solution, by ray casting.

#include "client/camera.h"
#include "client/png_file.h"
#include "meshing/display_mesh.h"

#include <optional>

namespace alvor {

struct RenderOptions {
  std::optional<Camera> camera;    ///< default_camera with `size` when empty
  PictureSize size;                ///< without a camera only
  std::optional<double> exposure;  ///< automatic_exposure when empty; give one to all frames of a solve
  bool wireframe = false;          ///< draw the outlines of the leaves
  int samples_per_side = 2;        ///< 2 means 2 x 2 rays per pixel
};

/// Surfaces with their radiosity, interpolated; the backs of surfaces are looked through. Uses all cores; the same arguments
/// give the same picture. Requires: !mesh.triangles.empty(), samples_per_side >= 1, a size of at least one pixel.
Image render(const DisplayMesh& mesh, const RenderOptions& options);

/// The exposure that `render` would choose for this view.
double automatic_exposure(const DisplayMesh& mesh, const Camera& camera);

}  // namespace alvor
