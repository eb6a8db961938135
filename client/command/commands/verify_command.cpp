// alvor verify SCENE SOLUTION: measures the error of a solution by path tracing.

#include "client/command/commands/commands.h"
#include "client/command/commands/outputs.h"
#include "client/command/commands/served_solution.h"
#include "client/command/options/absorption_option.h"
#include "client/command/options/input_file.h"
#include "client/command/options/light_options.h"
#include "client/command/options/option_checks.h"
#include "client/command/options/served_solve_option.h"
#include "client/command/options/translucent_option.h"
#include "client/command/options/up_option.h"
#include "client/command/output/failure.h"
#include "client/command/output/files.h"
#include "client/command/output/notes.h"
#include "client/command/output/numbers.h"
#include "client/command/output/output_file.h"
#include "client/command/output/status_line.h"
#include "client/command/output/verify_report.h"
#include "client/verify/error_picture.h"
#include "proto/codec.h"

#include <chrono>
#include <ctime>
#include <memory>
#include <optional>
#include <utility>

namespace alvor {

namespace {

struct VerifyCommand {
  std::filesystem::path scene, solution;
  ServerChoice server;  ///< given: `scene` is the name of a solve, and there is no solution file
  std::string format;   ///< format of the file from stdin
  VerifyOptions options;
  std::string absorption;  ///< three numbers; empty: none
  LightOptions light;
  std::vector<std::string> translucent;  ///< MATERIAL=T
  std::string up;                        ///< "y" or "z"; empty: as the solution says
  std::optional<double> max_error;
  std::filesystem::path csv, picture;  ///< empty: not asked for
  bool json = false;
};

Verification verify_with_progress(const VerifyCommand& command, const Scene& scene, const DisplayMesh& solution) {
  StatusLine line;
  VerifyOptions options = command.options;
  options.trace.on_progress = [&](double share) {
    if (line.on_terminal() && (line.due() || share == 1)) line.show(progress_bar(share) + " " + percent(share) + " of the paths");
  };
  try {
    return verify(scene, solution, options);
  } catch (const MismatchError& error) {
    throw Failure(ExitStatus::bad_scene,
                  name_of(command.server.is_given() ? command.scene : command.solution) + ": " + error.what());
  }
}

Verification verify_timed(const VerifyCommand& command, const Scene& scene, const DisplayMesh& solution, VerifyTimes& times) {
  using Clock = std::chrono::steady_clock;
  const auto begin = Clock::now();
  const std::clock_t cpu_begin = std::clock();
  Verification verification = verify_with_progress(command, scene, solution);
  times.elapsed_s = std::chrono::duration<double>(Clock::now() - begin).count();
  times.cpu_s = static_cast<double>(std::clock() - cpu_begin) / CLOCKS_PER_SEC;
  return verification;
}

void require_small_error(const VerifyCommand& command, double nrmse) {
  if (!command.max_error || nrmse <= *command.max_error) return;
  throw Failure(ExitStatus::failed, "nRMSE " + percent(nrmse) + " exceeds --max-error " + percent(*command.max_error));
}

void require_outputs(const VerifyCommand& command) {
  require_output({command.csv, {}}, table_kind, "--csv");
  require_output({command.picture, {}}, picture_kind, "--picture");
  reserve_stdout_for({command.csv, command.picture});
}

/// A scene and its solution.
struct Solved {
  Scene scene;
  DisplayMesh solution;
  std::vector<std::string> warnings;
};

Solved read_files(const VerifyCommand& command) {
  SceneImport import;
  take_light_options(command.light, import);
  take_translucent(command.translucent, import.options);
  DisplayMesh solution = read_solution(command.solution, command.format);
  take_up(command.up, solution.up);
  import.options.set_up_axis(encode(solution.up));
  SceneFile file = read_scene(command.scene, command.format, import);
  take_absorption(command.absorption, file.scene);
  warn(file.warnings);
  return {std::move(file.scene), std::move(solution), std::move(file.warnings)};
}

Solved read_from_server(const VerifyCommand& command) {
  ServedSolve solve = read_served_solve(command.server, command.scene);
  Solved solved{std::move(solve.scene), std::move(solve.mesh), {}};
  if (!solve.unfinished.empty()) solved.warnings.push_back(std::move(solve.unfinished));
  return solved;
}

void require_what_is_verified(const VerifyCommand& command) {
  require_server(command.server, command.scene);
  if (command.server.is_given()) {
    if (!command.solution.empty())
      throw Failure(ExitStatus::usage,
                    "solution: --server has the solution of a solve; " + command.solution.string() + " is one more");
    return;
  }
  if (command.solution.empty()) throw CLI::RequiredError("solution");
  require_inputs({{InputKind::scene, command.scene}, {InputKind::solution, command.solution}}, command.format);
}

void run_verify(const VerifyCommand& command) {
  require_what_is_verified(command);
  require_outputs(command);
  const Solved solved = command.server.is_given() ? read_from_server(command) : read_files(command);
  VerifyTimes times;
  const Verification verification = verify_timed(command, solved.scene, solved.solution, times);
  if (!command.csv.empty()) write_output(command.csv, verified_csv(verification.points));
  if (!command.picture.empty()) write_picture(command.picture, error_picture(solved.solution, verification, {}));
  results() << (command.json ? verify_json(solved.scene, verification, times, solved.warnings)
                             : verify_summary(solved.scene, verification, times));
  require_small_error(command, verification.errors.nrmse.value);
}

constexpr std::size_t most_points = 10'000'000;  // each takes some hundred bytes

void add_effort(CLI::App& command, VerifyCommand& options) {
  TraceOptions& trace = options.options.trace;
  command.add_option("--points", options.options.points, "Number of points, uniform by area over all fronts (1000)")
      ->check(whole_from(2))
      ->check(CLI::Range(std::size_t{2}, most_points));
  command.add_option("--paths", trace.paths, "Number of paths from each point, rounded up to whole rounds (1000)")
      ->check(whole_from(2));
  command.add_option("--time-limit", trace.time_limit_s, "Send no more paths from any point after this many seconds")
      ->check(above_up_to(0, 1e9));
  command.add_option("--seed", trace.seed, "The same seed gives the same points and paths (1)")->check(whole_from(0));
  command.add_option("--threads", trace.threads, "Worker threads (as many as the machine has)")->check(whole_from(1));
}

void add_results(CLI::App& command, VerifyCommand& options) {
  command
      .add_option("--max-error", options.max_error,
                  "Exit with status 5 if the nRMSE exceeds this; 0.02 is 2 %. Its confidence interval does not count")
      ->check(above_up_to(0, 1e9));
  command.add_option("--csv", options.csv, "Write the truth, its standard error and the solution at each point")
      ->type_name("FILE");
  command.add_option("--picture", options.picture, "Draw the error, blue where the solution is too dark, red where too bright")
      ->type_name("FILE.png");
  add_up_option(command, options.up);
  command.add_flag("--json", options.json, "Print one JSON object instead of a summary");
}

}  // namespace

void add_verify_command(CLI::App& app) {
  const auto options = std::make_shared<VerifyCommand>();
  CLI::App& command = *app.add_subcommand("verify", "Measure the error of a solution by unbiased path tracing");
  command
      .add_option("scene", options->scene, "The scene file that was solved, or scenes/SCENE/solves/SOLVE on a server; - is stdin")
      ->required()
      ->type_name("SCENE");
  command
      .add_option("solution", options->solution, "Solution file that alvor solve wrote; - is stdin; none of a solve on a server")
      ->type_name("SOLUTION");
  add_format_option(command, options->format);
  add_absorption_option(command, options->absorption);
  add_light_options(command, options->light);
  add_translucent_option(command, options->translucent);
  add_effort(command, *options);
  add_results(command, *options);
  add_served_solve_option(command, options->server);
  command.callback([options] { run_verify(*options); });
}

}  // namespace alvor
