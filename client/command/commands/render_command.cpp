// alvor render SOLUTION: draws a solution file or a solve on a server.

#include "client/command/commands/commands.h"
#include "client/command/commands/outputs.h"
#include "client/command/commands/served_solution.h"
#include "client/command/options/camera_options.h"
#include "client/command/options/false_colour_options.h"
#include "client/command/options/input_file.h"
#include "client/command/options/option_checks.h"
#include "client/command/options/served_solve_option.h"
#include "client/command/options/up_option.h"
#include "client/command/output/failure.h"
#include "client/command/output/notes.h"
#include "client/command/output/output_file.h"
#include "client/picture/render.h"
#include "client/picture/stage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>

namespace alvor {

namespace {

struct RenderCommand {
  std::string solution;
  ServerChoice server;  ///< not given: `solution` is a file
  bool ambient = false;
  OutputFile output;
  std::string format;  ///< format of a solution from stdin
  PictureSize size;
  CameraOptions camera;
  FalseColourOptions false_colour;
  double exposure_stops = 0;
  bool wireframe = false;
};

DisplayMesh read_from_anywhere(const RenderCommand& command) {
  if (command.server.is_given()) return read_served_solution({command.server, command.solution, command.ambient});
  require_server(command.server, command.solution);
  return read_solution(command.solution, command.format);
}

std::string place_text(Vec3 p) {
  char text[96];
  std::snprintf(text, sizeof text, "%.4g,%.4g,%.4g", p.x, p.y, p.z);
  return text;
}

/// Warns if the chosen camera sees no light: it may be inside a wall, or look away from everything.
void warn_of_black_view(const DisplayMesh& mesh, const Camera& camera) {
  if (std::ranges::all_of(mesh.radiosity, &RgbF::is_zero))
    return warn(std::array{std::string("the solution is dark: no surface has any light")});
  const Stage stage(mesh);
  bool sees_light = false;
  stage.glance(camera, [&](const Seen& seen) { sees_light = sees_light || !stage.radiosity(seen).is_zero(); });
  if (sees_light) return;
  const Camera inside = default_camera(mesh, stage.caster(), {camera.width, camera.height});
  warn(std::array{"the camera at " + place_text(camera.eye) + " sees nothing but black: it may stand in a wall. Try --eye " +
                  place_text(inside.eye) + " --target " + place_text(inside.target)});
}

void run_render(const RenderCommand& command) {
  require_inputs({{InputKind::solution, command.solution}}, command.format);
  require_output(command.output, picture_kind, "--output");
  reserve_stdout_for({command.output.path});
  RenderOptions options;
  options.false_colour = false_colour_of(command.false_colour, command.size);
  options.wireframe = command.wireframe;
  const bool shows_errors = options.false_colour && options.false_colour->shown == Shown::error;
  if (shows_errors && command.ambient)
    throw Failure(ExitStatus::usage, "--ambient: errors are told without the ambient term; leave it out with --show error");
  DisplayMesh mesh = read_from_anywhere(command);
  if (shows_errors) require_told_errors(mesh, command.solution);
  take_up(command.camera.up, mesh.up);
  options.camera = camera_of(command.camera, mesh, view_size(command.size, options.false_colour));
  warn_of_black_view(mesh, *options.camera);
  if (!options.false_colour) options.exposure = automatic_exposure(mesh, *options.camera) * std::exp2(command.exposure_stops);
  write_picture(command.output.path, render(mesh, options));
}

void add_source(CLI::App& command, RenderCommand& options) {
  command
      .add_option("solution", options.solution,
                  "Solution file that alvor solve wrote, or scenes/SCENE/solves/SOLVE on a server; - is stdin")
      ->required()
      ->type_name("SOLUTION");
  add_format_option(command, options.format);
  CLI::Option* server = &add_server_option(command, options.server, "Server of the solve; its newest state is drawn");
  command
      .add_flag("--ambient", options.ambient,
                "Brighten the picture by an estimate of the light not yet distributed (ambient term)")
      ->needs(server);
}

void add_picture(CLI::App& command, RenderCommand& options) {
  add_output_option(command, options.output, picture_kind, "Picture to write: .png")->required()->type_name("IMAGE.png");
  command.add_option("--width", options.size.width, "Width of the picture, pixels (1024)")->check(CLI::Range(1, 16384));
  command.add_option("--height", options.size.height, "Height of the picture, pixels (768)")->check(CLI::Range(1, 16384));
  CLI::Option* exposure = command.add_option("--exposure", options.exposure_stops,
                                             "Stops by which the picture is brighter than with automatic exposure (0)");
  exposure->check(above_up_to(-50, 50));
  command.add_flag("--wireframe", options.wireframe, "Draw the outlines of the leaves");
  add_false_colour_options(command, options.false_colour, *exposure);
}

}  // namespace

void add_render_command(CLI::App& app) {
  const auto options = std::make_shared<RenderCommand>();
  CLI::App& command = *app.add_subcommand("render", "Draw a solution");
  add_source(command, *options);
  add_picture(command, *options);
  add_camera_options(command, options->camera);
  command.callback([options] { run_render(*options); });
}

}  // namespace alvor
