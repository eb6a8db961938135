#pragma once
// Renders pictures of a solution by ray casting.

#include "client/picture/camera.h"
#include "client/picture/false_colour.h"
#include "client/picture/png_file.h"
#include "meshing/display_mesh.h"

#include <functional>
#include <optional>

namespace alvor {

class Stage;
struct Seen;

struct RenderOptions {
  std::optional<Camera> camera;             ///< camera of the view without legend; empty: default_camera of view_size(size)
  PictureSize size;                         ///< size of the whole picture; used only without a camera
  std::optional<double> exposure;           ///< empty: automatic_exposure; give one to all frames of a solve
  std::optional<FalseColour> false_colour;  ///< if set, shows irradiance by colours, without exposure
  bool wireframe = false;                   ///< draw the outlines of the leaves
  int samples_per_side = 2;                 ///< 2 means 2 x 2 rays per pixel
};

/// Returns the size of the view in a picture: what the legend, if there is one, leaves of it.
PictureSize view_size(PictureSize picture, const std::optional<FalseColour>& false_colour);

/// Renders the surfaces with their interpolated radiosity or irradiance; back sides are transparent. Uses all cores; the same
/// arguments give the same picture. Requires: !mesh.triangles.empty(), samples_per_side >= 1, a view of at least one pixel.
Image render(const DisplayMesh& mesh, const RenderOptions& options);

/// Renders a view in which `colour` returns the colour of each visible point: linear, in [0, 1]. It is called from many threads.
Image render(const Stage& stage, const Camera& camera, const std::function<Rgb(const Seen&)>& colour);

/// Returns the exposure that `render` would choose for this view.
double automatic_exposure(const DisplayMesh& mesh, const Camera& camera);

}  // namespace alvor
