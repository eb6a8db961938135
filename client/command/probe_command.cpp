// alvor probe SOLUTION: irradiance and radiosity at given points.

#include "client/command/commands.h"
#include "client/command/failure.h"
#include "client/command/files.h"
#include "client/command/outputs.h"
#include "client/probe.h"
#include "client/whole_file.h"

#include <algorithm>
#include <array>
#include <iostream>
#include <memory>

namespace alvor {

namespace {

struct ProbeCommand {
  std::filesystem::path solution;
  std::filesystem::path points;
  std::filesystem::path output;  ///< empty: stdout
};

std::vector<ProbePoint> read_asked_points(const std::filesystem::path& path) {
  try {
    return read_points(path);
  } catch (const FileError& error) {
    throw Failure(ExitStatus::bad_scene, error.what());
  }
}

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
  if (!command.output.empty()) require_writable(command.output, "--output");
  const std::vector<ProbePoint> points = read_asked_points(command.points);
  const std::vector<ProbeSample> samples = probe(read_solution(command.solution), points);
  warn_of_enclosed(samples);
  if (command.output.empty()) std::cout << samples_csv(samples);
  else write_whole_file(command.output, samples_csv(samples));
}

}  // namespace

void add_probe_command(CLI::App& app) {
  const auto options = std::make_shared<ProbeCommand>();
  CLI::App& command = *app.add_subcommand("probe", "Read a solution at points");
  command.add_option("solution", options->solution, "What solve wrote")->required()->type_name("SOLUTION");
  command.add_option("--points", options->points, "Lines x,y,z,nx,ny,nz; metres")->required()->type_name("P.csv");
  command.add_option("-o,--output", options->output, "Write here instead of to stdout")->type_name("OUT.csv");
  command.callback([options] { run_probe(*options); });
}

}  // namespace alvor
