// alvor compare SCENE -o DIR: shows how fast the strategies approach the solution, by a table, plots and pictures.

#include "radiosity/solve/compare.h"

#include "client/command/commands/commands.h"
#include "client/command/commands/interrupt.h"
#include "client/command/commands/outputs.h"
#include "client/command/options/input_file.h"
#include "client/command/options/option_checks.h"
#include "client/command/options/up_option.h"
#include "client/command/output/compare_plots.h"
#include "client/command/output/display.h"
#include "client/command/output/failure.h"
#include "client/command/output/files.h"
#include "client/command/output/notes.h"
#include "client/command/output/numbers.h"
#include "client/command/output/table.h"
#include "client/picture/render.h"
#include "import/base/whole_file.h"

#include <cmath>
#include <iostream>
#include <memory>

namespace alvor {

namespace {

constexpr PictureSize picture_size{640, 480};

struct CompareCommand {
  std::filesystem::path scene;
  std::string format;  ///< format of a scene from stdin
  std::filesystem::path folder;
  std::string up;  ///< "y" or "z"; empty: as the file says
  CompareOptions options;
};

std::string curve_table(const Comparison& comparison) {
  std::string table = "strategy,steps,cpu_s,rms_error\n";
  for (const StrategyCourse& course : comparison.courses)
    for (const ErrorSample& sample : course.curve)
      table.append(text(course.strategy))
          .append("," + std::to_string(sample.steps))
          .append("," + shortest(sample.cpu_s))
          .append("," + shortest(sample.error) + "\n");
  return table;
}

// Draws all pictures with the same camera and exposure.
void draw(const CompareCommand& command, const BaseMesh& mesh, const Comparison& comparison) {
  const Snapshot converged{0, {}, comparison.converged};
  const DisplayMesh solution = solution_mesh(mesh, converged.leaves);
  RenderOptions view;
  view.camera = default_camera(solution, picture_size);
  view.exposure = automatic_exposure(solution, *view.camera);
  write_png(command.folder / "converged.png", render(solution, view));
  for (const StrategyCourse& course : comparison.courses) {
    const Snapshot moment{0, narrow(course.ambient_irradiance), course.leaves};
    write_png(command.folder / (std::string(text(course.strategy)) + ".png"), render(shown_mesh(mesh, moment, converged), view));
  }
}

std::string steps_text(double error, const StrategyCourse& course) {
  const auto steps = steps_to(error, course);
  return steps ? std::to_string(*steps) : "-";
}

std::string summary_of(const CompareCommand& command, const Comparison& comparison) {
  std::vector<std::vector<std::string>> rows{{"strategy", "error after " + std::to_string(command.options.steps) + " steps",
                                              "steps to 10 %", "1 %", "0.1 %", "1e-6", "CPU ms to the end"}};
  for (const StrategyCourse& course : comparison.courses)
    rows.push_back({std::string(text(course.strategy)), percent(course.error), steps_text(0.1, course), steps_text(0.01, course),
                    steps_text(1e-3, course), steps_text(1e-6, course),
                    std::to_string(std::llround(1e3 * course.curve.back().cpu_s))});
  return std::to_string(comparison.patches) + " patches with rows, " + std::to_string(comparison.leaves) + " leaves\n" +
         aligned(rows);
}

Comparison compare(const CompareCommand& command, const BaseMesh& mesh) {
  const Interrupt interrupt;
  Comparison comparison = compare_strategies(mesh, command.options, interrupt.token());
  if (interrupt.token().stop_requested()) throw Failure(ExitStatus::failed, "the comparison was cancelled");
  if (comparison.courses.empty())
    throw Failure(ExitStatus::bad_scene, name_of(command.scene) + ": nothing emits light, so there is nothing to compare");
  return comparison;
}

void run_compare(const CompareCommand& command) {
  require_inputs({{InputKind::scene, command.scene}}, command.format);
  make_folder(command.folder, "compare.csv", "--output");
  SceneFile file = read_scene(command.scene, command.format);
  take_up(command.up, file.scene.up);
  warn(file.warnings);
  const BaseMesh mesh(file.scene);
  if (mesh.roots().empty()) throw Failure(ExitStatus::bad_scene, name_of(command.scene) + ": all faces are degenerate");
  const Comparison comparison = compare(command, mesh);
  write_whole_file(command.folder / "compare.csv", curve_table(comparison));
  draw(command, mesh, comparison);
  notes() << summary_of(command, comparison);
  if (!draw_compare_plots(command.folder))
    std::cerr << "plots were skipped: gnuplot was not found or could not draw; see "
              << (command.folder / "compare.gnuplot").string() << '\n';
  notes() << "wrote " << command.folder.string() << '\n';
}

}  // namespace

void add_compare_command(CLI::App& app) {
  const auto options = std::make_shared<CompareCommand>();
  CLI::App& command = *app.add_subcommand("compare", "Compare the strategies that distribute light");
  command.add_option("scene", options->scene, "OBJ, glTF, GLB or another scene file; - is stdin")->required()->type_name("SCENE");
  add_format_option(command, options->format);
  command.add_option("-o,--output", options->folder, "Folder for the table, plots and pictures")->required()->type_name("DIR");
  add_up_option(command, options->up);
  command.add_option("--steps", options->options.steps, "Draw the pictures after this many shots or gathered patches (100)")
      ->check(CLI::Range(1, 1'000'000));
  command
      .add_option("--tolerance", options->options.tolerance,
                  "Refine the mesh until the estimated relative error is this small (0.02)")
      ->check(above_up_to(0, 1));
  command.add_option("--threads", options->options.threads, "Worker threads that trace rays (as many as the machine has)")
      ->check(CLI::Range(1, 1024));
  command.add_option("--seed", options->options.seed, "The same seed gives the same mesh and rows (1)")->check(whole_from(0));
  command.callback([options] { run_compare(*options); });
}

}  // namespace alvor
