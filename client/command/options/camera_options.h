#pragma once
// Where a picture is taken from, as options say.

#include "client/picture/camera.h"

#include <CLI/CLI.hpp>

#include <optional>
#include <string>

namespace alvor {

/// What is empty is chosen to suit the solution. Places and directions are three numbers; `up` may be "y" or "z" instead.
struct CameraOptions {
  std::string eye, target, up;
  std::optional<double> fov_degrees;
};

void add_camera_options(CLI::App& command, CameraOptions& options);

/// For a picture of `size`. Throws Failure (usage) if nothing could be seen that way.
Camera camera_of(const CameraOptions& options, const DisplayMesh& mesh, PictureSize size);

}  // namespace alvor
