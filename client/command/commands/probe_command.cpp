// alvor probe SOLUTION: prints irradiance and radiosity at given points.

#include "client/command/commands/commands.h"
#include "client/command/commands/outputs.h"
#include "client/command/options/absorption_option.h"
#include "client/command/options/input_file.h"
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

void run_probe(const ProbeCommand& command) {
  require_inputs({{InputKind::solution, command.solution}, {InputKind::points, command.points}}, command.format);
  require_output(command.output, table_kind, "--output");
  const std::vector<ProbePoint> points = read_asked_points(command.points);
  Scene medium;
  take_absorption(command.absorption, medium);
  const std::vector<ProbeSample> samples = probe(read_solution(command.solution, command.format), points, medium.absorption);
  warn_of_enclosed(samples);
  write_output(command.output.path.empty() ? "-" : command.output.path, samples_csv(samples));
}

}  // namespace

void add_probe_command(CLI::App& app) {
  const auto options = std::make_shared<ProbeCommand>();
  CLI::App& command = *app.add_subcommand("probe", "Read irradiance and radiosity of a solution at points");
  command.add_option("solution", options->solution, "Solution file that alvor solve wrote; - is stdin")
      ->required()
      ->type_name("SOLUTION");
  add_format_option(command, options->format);
  command.add_option("--points", options->points, "File with lines x,y,z,nx,ny,nz (position in metres, normal); - is stdin")
      ->required()
      ->type_name("P.csv");
  add_absorption_option(command, options->absorption);
  add_output_option(command, options->output, table_kind, "Table to write instead of printing it: .csv or .txt")
      ->type_name("OUT.csv");
  command.callback([options] { run_probe(*options); });
}

}  // namespace alvor
