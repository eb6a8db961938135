// alvor probe SOLUTION: prints irradiance and radiosity at given points.

#include "client/command/commands/commands.h"
#include "client/command/commands/outputs.h"
#include "client/command/commands/served_solution.h"
#include "client/command/options/absorption_option.h"
#include "client/command/options/input_file.h"
#include "client/command/options/served_solve_option.h"
#include "client/command/options/solve_name.h"
#include "client/command/output/notes.h"
#include "client/command/output/output_file.h"
#include "client/verify/probe.h"

#include <algorithm>
#include <array>
#include <memory>

namespace alvor {

namespace {

struct ProbeCommand {
  std::filesystem::path solution;
  ServerChoice server;  ///< given: `solution` is the name of a solve
  std::filesystem::path points;
  OutputFile output;       ///< stdout if not asked for
  std::string format;      ///< format of a solution from stdin
  std::string absorption;  ///< three numbers; empty: none
};

void warn_of_enclosed(std::span<const ProbeSample> samples) {
  const auto enclosed = std::ranges::count(samples, ProbePlace::enclosed, &ProbeSample::place);
  if (enclosed == 0) return;
  const auto first = std::ranges::find(samples, ProbePlace::enclosed, &ProbeSample::place) - samples.begin();
  warn(std::array{
      std::to_string(enclosed) + " of " + std::to_string(samples.size()) +
      " points lie inside a solid or outside the room (most of what they see are backs of surfaces): nan. The first is point " +
      std::to_string(first + 1)});
}

void require_what_is_read(const ProbeCommand& command) {
  if (command.server.is_given()) {
    scene_name_of(command.solution);  // before a server is asked
    return require_inputs({{InputKind::points, command.points}}, "");
  }
  require_server(command.server, command.solution);
  require_inputs({{InputKind::solution, command.solution}, {InputKind::points, command.points}}, command.format);
}

std::vector<ProbeSample> samples_of(const ProbeCommand& command, std::span<const ProbePoint> points) {
  if (command.server.is_given()) {
    const ServedSolve solve = read_served_solve(command.server, command.solution);
    return probe(solve.mesh, points, solve.scene.absorption);
  }
  Scene medium;
  take_absorption(command.absorption, medium);
  return probe(read_solution(command.solution, command.format), points, medium.absorption);
}

void run_probe(const ProbeCommand& command) {
  require_what_is_read(command);
  require_output(command.output, table_kind, "--output");
  const std::vector<ProbeSample> samples = samples_of(command, read_asked_points(command.points));
  warn_of_enclosed(samples);
  write_output(command.output.path.empty() ? "-" : command.output.path, samples_csv(samples));
}

}  // namespace

void add_probe_command(CLI::App& app) {
  const auto options = std::make_shared<ProbeCommand>();
  CLI::App& command = *app.add_subcommand("probe", "Read irradiance and radiosity of a solution at points");
  command
      .add_option("solution", options->solution,
                  "Solution file that alvor solve wrote, or scenes/SCENE/solves/SOLVE on a server; - is stdin")
      ->required()
      ->type_name("SOLUTION");
  add_format_option(command, options->format);
  command.add_option("--points", options->points, "File with lines x,y,z,nx,ny,nz (position in metres, normal); - is stdin")
      ->required()
      ->type_name("P.csv");
  add_absorption_option(command, options->absorption);
  add_output_option(command, options->output, table_kind, "Table to write instead of printing it: .csv or .txt")
      ->type_name("OUT.csv");
  add_served_solve_option(command, options->server);
  command.callback([options] { run_probe(*options); });
}

}  // namespace alvor
