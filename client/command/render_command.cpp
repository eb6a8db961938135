// alvor render SOLUTION: a picture.

#include "client/command/commands.h"
#include "client/command/failure.h"
#include "client/command/files.h"
#include "client/command/numbers.h"
#include "client/command/option_checks.h"
#include "client/render.h"

#include <cmath>
#include <memory>

namespace alvor {

namespace {

/// What is empty is chosen to suit the solution. Places and directions are three numbers.
struct RenderCommand {
  std::filesystem::path solution;
  std::filesystem::path output;
  PictureSize size;
  double exposure_stops = 0;
  bool wireframe = false;
  std::string eye, target, up;
  std::optional<double> fov_degrees;
};

void take(const std::string& triple, Vec3& place) {
  if (const auto numbers = parse_numbers(triple, 3)) place = {(*numbers)[0], (*numbers)[1], (*numbers)[2]};
}

void require_view(const Camera& camera) {
  const Vec3 view = camera.target - camera.eye;
  if (length(view) == 0) throw Failure(ExitStatus::usage, "--eye and --target are the same place");
  if (length(cross(view, camera.up)) <= 1e-9 * length(view) * length(camera.up))
    throw Failure(ExitStatus::usage, "--up lies along the view");
}

Camera camera_of(const RenderCommand& command, const DisplayMesh& mesh) {
  Camera camera = default_camera(mesh, command.size);
  take(command.eye, camera.eye);
  take(command.target, camera.target);
  take(command.up, camera.up);
  camera.vertical_fov_degrees = command.fov_degrees.value_or(camera.vertical_fov_degrees);
  require_view(camera);
  return camera;
}

void require_picture_path(const std::filesystem::path& path) {
  if (path.extension() != ".png") throw Failure(ExitStatus::usage, "--output " + path.string() + ": a picture ends in .png");
  require_writable(path, "--output");
}

void run_render(const RenderCommand& command) {
  require_picture_path(command.output);
  const DisplayMesh mesh = read_solution(command.solution);
  RenderOptions options;
  options.camera = camera_of(command, mesh);
  options.exposure = automatic_exposure(mesh, *options.camera) * std::exp2(command.exposure_stops);
  options.wireframe = command.wireframe;
  write_png(command.output, render(mesh, options));
}

void add_camera(CLI::App& command, RenderCommand& options) {
  command.add_option("--eye", options.eye, "Where the camera is, metres")->type_name("X,Y,Z")->check(triple());
  command.add_option("--target", options.target, "What it looks at")->type_name("X,Y,Z")->check(triple());
  command.add_option("--up", options.up, "What is upright in the picture")->type_name("X,Y,Z")->check(triple());
  command.add_option("--fov", options.fov_degrees, "Vertical angle of view, degrees")->check(above_up_to(0, 170));
}

}  // namespace

void add_render_command(CLI::App& app) {
  const auto options = std::make_shared<RenderCommand>();
  CLI::App& command = *app.add_subcommand("render", "Draw a solution");
  command.add_option("solution", options->solution, "What solve wrote")->required()->type_name("SOLUTION");
  command.add_option("-o,--output", options->output, "The picture")->required()->type_name("IMAGE.png");
  command.add_option("--width", options->size.width, "Pixels (1024)")->check(CLI::Range(1, 16384));
  command.add_option("--height", options->size.height, "Pixels (768)")->check(CLI::Range(1, 16384));
  command.add_option("--exposure", options->exposure_stops, "Stops brighter than automatic")->check(above_up_to(-50, 50));
  command.add_flag("--wireframe", options->wireframe, "Draw the outlines of the leaves");
  add_camera(command, *options);
  command.callback([options] { run_render(*options); });
}

}  // namespace alvor
