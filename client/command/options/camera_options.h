#pragma once
// Options for the camera of a picture.

#include "client/picture/camera.h"

#include <CLI/CLI.hpp>

#include <optional>
#include <string>

namespace alvor {

/// Empty options are chosen to suit the solution. Positions and directions are three numbers; `up` may also be "y" or "z".
struct CameraOptions {
  std::string eye, target, up;
  std::optional<double> fov_degrees;
};

void add_camera_options(CLI::App& command, CameraOptions& options);

/// Returns the camera for a picture of `size`. Throws Failure (usage) if the options make no view.
Camera camera_of(const CameraOptions& options, const DisplayMesh& mesh, PictureSize size);

}  // namespace alvor
