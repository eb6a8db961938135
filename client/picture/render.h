#pragma once
// Pictures of a solution, by ray casting.

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
  std::optional<Camera> camera;             ///< of the view, legend apart; default_camera of view_size(size) when empty
  PictureSize size;                         ///< of the whole picture; without a camera only
  std::optional<double> exposure;           ///< automatic_exposure when empty; give one to all frames of a solve
  std::optional<FalseColour> false_colour;  ///< shows irradiance instead; there is no exposure then
  bool wireframe = false;                   ///< draw the outlines of the leaves
  int samples_per_side = 2;                 ///< 2 means 2 x 2 rays per pixel
};

/// What a legend, if there is one, leaves of a picture for the view.
PictureSize view_size(PictureSize picture, const std::optional<FalseColour>& false_colour);

/// Surfaces with their radiosity or irradiance, interpolated; the backs of surfaces are looked through. Uses all cores; the same
/// arguments give the same picture. Requires: !mesh.triangles.empty(), samples_per_side >= 1, a view of at least one pixel.
Image render(const DisplayMesh& mesh, const RenderOptions& options);

/// A view in which each visible place has the colour that `colour` says: linear, in [0, 1]. It is asked from many threads.
Image render(const Stage& stage, const Camera& camera, const std::function<Rgb(const Seen&)>& colour);

/// The exposure that `render` would choose for this view.
double automatic_exposure(const DisplayMesh& mesh, const Camera& camera);

}  // namespace alvor
