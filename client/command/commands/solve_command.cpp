// alvor solve SCENE: reads the scene, has it solved here or by a server, follows the solve and writes the results.

#include "client/command/commands/commands.h"
#include "client/command/commands/connection.h"
#include "client/command/commands/edited_scene.h"
#include "client/command/commands/interrupt.h"
#include "client/command/commands/outputs.h"
#include "client/command/commands/submitted_scene.h"
#include "client/command/options/absorption_option.h"
#include "client/command/options/input_file.h"
#include "client/command/options/light_options.h"
#include "client/command/options/option_checks.h"
#include "client/command/options/translucent_option.h"
#include "client/command/options/up_option.h"
#include "client/command/output/failure.h"
#include "client/command/output/files.h"
#include "client/command/output/notes.h"
#include "client/picture/units.h"
#include "proto/codec.h"

#include <map>
#include <memory>
#include <optional>

namespace alvor {

namespace {

const std::map<std::string, v1::Strategy> strategies{{"auto", v1::STRATEGY_UNSPECIFIED},
                                                     {"gather", v1::STRATEGY_GATHER},
                                                     {"shoot", v1::STRATEGY_SHOOT},
                                                     {"sorted", v1::STRATEGY_SORTED},
                                                     {"sorted+ambient", v1::STRATEGY_SORTED_AMBIENT},
                                                     {"overshoot", v1::STRATEGY_OVERSHOOT}};

const std::map<std::string, v1::Priority> priorities{
    {"low", v1::PRIORITY_LOW}, {"normal", v1::PRIORITY_NORMAL}, {"high", v1::PRIORITY_HIGH}};

const std::map<std::string, v1::FormFactors> form_factor_methods{{"auto", v1::FORM_FACTORS_UNSPECIFIED},
                                                                 {"nusselt", v1::FORM_FACTORS_NUSSELT},
                                                                 {"hemicube", v1::FORM_FACTORS_HEMICUBE},
                                                                 {"analytic", v1::FORM_FACTORS_ANALYTIC}};

constexpr double pace_of_frames_s = 0.04;

/// The options of the command. Unset ones are left to the server.
struct SolveCommand {
  std::filesystem::path scene;
  std::string format;  ///< format of a scene from stdin
  ServerChoice server;
  OutputOptions outputs;
  std::optional<double> tolerance, area_share;
  std::vector<std::string> objects;  ///< names
  std::optional<int> max_depth;
  std::optional<std::uint64_t> max_elements;
  std::optional<double> time_limit_s;
  std::optional<int> threads;
  std::optional<std::uint64_t> seed;
  std::string strategy = "auto";      ///< a key of `strategies`
  std::string priority = "normal";    ///< a key of `priorities`
  std::string form_factors = "auto";  ///< a key of `form_factor_methods`
  std::optional<double> pace_s;
  std::string absorption;  ///< three numbers; empty: none
  LightOptions light;
  std::vector<std::string> translucent;  ///< MATERIAL=T
  std::string up;                        ///< "y" or "z"; empty: as the file says
};

v1::SolveSpec spec_of(const SolveCommand& command) {
  v1::SolveSpec spec;
  if (command.tolerance) spec.set_tolerance(*command.tolerance);
  if (command.area_share) spec.set_area_share(*command.area_share);
  spec.mutable_objects()->Assign(command.objects.begin(), command.objects.end());
  if (command.max_depth) spec.set_max_depth(*command.max_depth);
  if (command.max_elements) spec.set_max_elements(*command.max_elements);
  if (command.threads) spec.set_threads(*command.threads);
  if (command.seed) spec.set_seed(*command.seed);
  if (command.time_limit_s) *spec.mutable_time_limit() = encode_seconds(*command.time_limit_s);
  spec.set_strategy(strategies.at(command.strategy));
  spec.set_priority(priorities.at(command.priority));
  spec.set_form_factors(form_factor_methods.at(command.form_factors));
  // Without a pause a small room would be finished between two frames.
  const double pace_s = command.pace_s.value_or(command.outputs.frames.empty() ? 0 : pace_of_frames_s);
  if (pace_s > 0) *spec.mutable_step_pause() = encode_seconds(pace_s);
  return spec;
}

SceneImport import_of(const SolveCommand& command, const std::string& file) {
  SceneImport import;
  v1::ImportOptions& options = import.options = import_options(file, command.scene);
  take_light_options(command.light, import);
  take_translucent(command.translucent, options);
  Scene given;
  take_absorption(command.absorption, given);
  if (!given.absorption.is_zero()) *options.mutable_absorption_per_meter() = encode(given.absorption);
  if (is_axis(command.up)) options.set_up_axis(encode(command.up == "z" ? UpAxis::z : UpAxis::y));
  return import;
}

/// A solve that has been followed to its end.
struct FollowedSolve {
  std::optional<BaseMesh> mesh;  ///< with the edits that somebody made meanwhile
  std::vector<std::string> warnings;
  Followed followed;
};

FollowedSolve solve_and_follow(const SolveCommand& command, RawScene bytes) {
  const SceneImport import = import_of(command, bytes.file);
  Interrupt interrupt;
  Connection connection(command.server);
  Client& client = connection.client();
  const v1::Scene scene = submit(client, std::move(bytes), import, command.scene);
  FollowedSolve solved;
  solved.warnings.assign(scene.warnings().begin(), scene.warnings().end());
  warn(solved.warnings);
  solved.mesh.emplace(client.with_patience([&] { return client.read_scene(scene.name()); }));
  const FollowOptions options{std::chrono::steady_clock::now(), !command.outputs.frames.empty()};
  const v1::Solve solve = client.create_solve(scene.name(), spec_of(command));
  if (connection.remote()) progress() << solve.name() << '\n';
  solved.followed = follow_own(client, solve, options, interrupt.token());
  solved.mesh = read_edited_mesh(client, *std::move(solved.mesh), solve.name(), edits_shown(solved.followed.mirror));
  return solved;
}

void run_solve(const SolveCommand& command) {
  require_inputs({{InputKind::scene, command.scene}}, command.format);
  prepare_outputs(command.outputs);
  const FollowedSolve solved = solve_and_follow(command, scene_bytes(command.scene, command.format));
  deliver(command.outputs, *solved.mesh, solved.followed, solved.warnings);
}

void add_limits(CLI::App& command, SolveCommand& options) {
  command.add_option("--tolerance", options.tolerance, "Stop when the estimated relative error is this small (0.02)")
      ->check(above_up_to(0, 1));
  command
      .add_option(
          "--area-share", options.area_share,
          "Stop when the told error is within the tolerance on this share of the area, relative to the irradiance there (1: the "
          "tolerance is that of the RMS error over the whole scene)")
      ->type_name("SHARE")
      ->check(above_up_to(0, 1));
  command
      .add_option("--for", options.objects,
                  "Keep the tolerance on this object of the scene and what hangs from it, on --area-share of their area (0.95), "
                  "and refine "
                  "nothing else; repeatable")
      ->type_name("OBJECT")
      ->allow_extra_args(false);
  command.add_option("--max-depth", options.max_depth, "Most levels of subdivision; 0 means no refinement (12)")
      ->check(CLI::Range(0, 15));
  command.add_option("--max-elements", options.max_elements, "Stop refining at this many leaves (200000)")->check(whole_from(1));
  command.add_option("--time-limit", options.time_limit_s, "Stop after this many seconds")->check(above_up_to(0, 1e9));
}

void add_method(CLI::App& command, SolveCommand& options) {
  command.add_option("--priority", options.priority, "Priority among the solves of a server: low, normal or high (normal)")
      ->check(CLI::IsMember(priorities));
  command.add_option("--strategy", options.strategy, "Order in which light is distributed (auto)")
      ->type_name("S")
      ->check(CLI::IsMember({"auto", "gather", "shoot", "sorted", "sorted+ambient", "overshoot"}));
  command.add_option("--form-factors", options.form_factors, "Method for transport rows (auto)")
      ->type_name("M")
      ->check(CLI::IsMember({"auto", "nusselt", "hemicube", "analytic"}));
  add_absorption_option(command, options.absorption);
  add_light_options(command, options.light);
  add_translucent_option(command, options.translucent);
  command.add_option("--threads", options.threads, "Worker threads (as many as the machine has)")->check(whole_from(1));
  command.add_option("--pace", options.pace_s, "Pause after each step, seconds; not counted as run time (0; 0.04 with --frames)")
      ->check(CLI::Range(0.0, 60.0));
  command.add_option("--seed", options.seed, "The same seed gives the same solution (1)")->check(whole_from(0));
}

}  // namespace

void add_solve_command(CLI::App& app) {
  const auto options = std::make_shared<SolveCommand>();
  CLI::App& command = *app.add_subcommand("solve", "Solve a scene");
  command.add_option("scene", options->scene, "OBJ, glTF, GLB or another scene file; - is stdin")->required()->type_name("SCENE");
  add_format_option(command, options->format);
  add_server_option(command, options->server, "Server that solves the scene, instead of this process");
  add_output_options(command, options->outputs);
  add_up_option(command, options->up);
  add_limits(command, *options);
  add_method(command, *options);
  command.callback([options] { run_solve(*options); });
}

}  // namespace alvor
