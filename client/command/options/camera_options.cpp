#include "client/command/options/camera_options.h"

#include "client/command/options/option_checks.h"
#include "client/command/options/up_option.h"
#include "client/command/output/failure.h"
#include "client/command/output/numbers.h"

namespace alvor {

namespace {

void take(const std::string& triple, Vec3& place) {
  if (const auto numbers = parse_numbers(triple, 3)) place = {(*numbers)[0], (*numbers)[1], (*numbers)[2]};
}

void require_view(const Camera& camera) {
  const Vec3 view = camera.target - camera.eye;
  if (length(view) == 0) throw Failure(ExitStatus::usage, "--eye and --target are the same place");
  if (length(cross(view, camera.up)) <= 1e-9 * length(view) * length(camera.up))
    throw Failure(ExitStatus::usage, "--up lies along the view");
}

}  // namespace

void add_camera_options(CLI::App& command, CameraOptions& options) {
  command.add_option("--eye", options.eye, "Position of the camera, metres")->type_name("X,Y,Z")->check(triple());
  command.add_option("--target", options.target, "Point that the camera looks at, metres")->type_name("X,Y,Z")->check(triple());
  command
      .add_option("--up", options.up, "Direction that is up in the picture: y, z or X,Y,Z (the axis that the solution file says)")
      ->type_name("y|z|X,Y,Z")
      ->check(CLI::IsMember({"y", "z"}) | triple());
  command.add_option("--fov", options.fov_degrees, "Vertical angle of view, degrees")->check(above_up_to(0, 170));
}

Camera camera_of(const CameraOptions& options, const DisplayMesh& mesh, PictureSize size) {
  Camera camera = default_camera(mesh, size);
  take(options.eye, camera.eye);
  take(options.target, camera.target);
  if (!is_axis(options.up)) take(options.up, camera.up);
  camera.vertical_fov_degrees = options.fov_degrees.value_or(camera.vertical_fov_degrees);
  require_view(camera);
  return camera;
}

}  // namespace alvor
