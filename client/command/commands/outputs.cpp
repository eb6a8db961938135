#include "client/command/commands/outputs.h"

#include "client/command/commands/solve_outcome.h"
#include "client/command/output/display.h"
#include "client/command/output/files.h"
#include "client/command/output/frames.h"
#include "client/command/output/notes.h"
#include "client/export/compact_file.h"
#include "client/export/solution_file.h"

#include <iostream>

namespace alvor {

namespace {

std::string solution_bytes(const std::string& extension, const BaseMesh& mesh, const SolutionMirror& mirror) {
  if (extension != ".alvor") return encode_solution(solution_mesh(mesh, mirror.leaves(), mirror.errors()), extension);
  const CoveringLeaves all = covering_leaves(mesh, mirror.leaves(), mirror.errors());
  return encode_compact(mesh, all.leaves, all.errors);
}

// Writes the solution and the frames, unless nothing was published because the solve failed at once.
void write_pictures(const OutputOptions& options, const BaseMesh& mesh, const Followed& followed) {
  if (followed.mirror.steps().empty()) return;
  if (!options.solution.path.empty())
    write_output(options.solution.path, solution_bytes(extension_of(options.solution, solution_kind), mesh, followed.mirror));
  if (!options.frames.empty()) write_frames(options.frames, mesh, followed.snapshots, {.ambient = !options.no_ambient});
}

void print_written(const std::filesystem::path& path) {
  if (!path.empty() && !is_stream(path)) notes() << "wrote " << path.string() << '\n';
}

void print_for_people(const OutputOptions& options, const Followed& followed, const MeanLight& light,
                      std::span<const ObjectError> errors) {
  notes() << summary(followed, light, errors);
  for (const auto& path : {options.solution.path, options.report, options.frames}) print_written(path);
}

std::string unfinished(const v1::Solve& solve) {
  switch (solve.state()) {
    case v1::Solve::FAILED: return "the solve failed: " + solve.end_reason();
    case v1::Solve::CANCELLED: return "the solve was cancelled";
    default: return "stopped watching before the solve had ended";
  }
}

}  // namespace

void add_output_options(CLI::App& command, OutputOptions& options) {
  add_output_option(command, options.solution, solution_kind,
                    "Write the solution: .glb, .ply, .alvor (small) or .vtu (for ParaView)")
      ->type_name("SOLUTION");
  command.add_option("--report", options.report, "Write one CSV line per published step")->type_name("R.csv");
  command.add_option("--frames", options.frames, "Draw the growing solution as frame_0000.png ... in this folder")
      ->type_name("DIR");
  command.add_flag("--no-ambient", options.no_ambient, "Draw frames without the ambient term");
  command.add_flag("--json", options.json, "Print one JSON object instead of a summary");
}

void prepare_outputs(const OutputOptions& options) {
  require_output(options.solution, solution_kind, "--output");
  require_output({options.report, {}}, table_kind, "--report");
  reserve_stdout_for({options.solution.path, options.report});
  if (!options.frames.empty()) make_folder(options.frames, "frame_0000.png", "--frames");
}

void deliver(const OutputOptions& options, const BaseMesh& mesh, const Followed& followed,
             std::span<const std::string> warnings) {
  // Files to stdout are written last, because the reader may have gone.
  const auto write_report = [&] { write_output(options.report, step_table(followed.mirror.steps())); };
  if (!options.report.empty() && !is_stream(options.report)) write_report();
  write_pictures(options, mesh, followed);
  const MeanLight light = mean_light(mesh, followed.mirror.leaves());
  if (is_stream(options.report)) write_report();
  constexpr std::size_t most_objects = 5;
  const auto errors = largest_errors(mesh, followed.mirror.leaves(), followed.mirror.errors(), most_objects);
  if (options.json) results() << outcome_json(followed, light, errors, warnings);
  else print_for_people(options, followed, light, errors);
  if (followed.solve.state() != v1::Solve::SUCCEEDED) throw Failure(ExitStatus::failed, unfinished(followed.solve));
}

}  // namespace alvor
