// alvor explain SCENE: prints the plan of a solve, or checks form factors.

#include "client/command/commands/commands.h"
#include "client/command/commands/outputs.h"
#include "client/command/options/absorption_option.h"
#include "client/command/options/input_file.h"
#include "client/command/options/light_options.h"
#include "client/command/options/translucent_option.h"
#include "client/command/output/failure.h"
#include "client/command/output/files.h"
#include "client/command/output/notes.h"
#include "client/command/output/plan_text.h"
#include "radiosity/form_factors/form_factor_checks.h"
#include "radiosity/plan/plan.h"
#include "radiosity/solve/solver.h"

#include <nlohmann/json.hpp>

#include <cstdio>
#include <iostream>
#include <memory>

namespace alvor {

namespace {

struct ExplainCommand {
  std::filesystem::path scene;
  std::string format;      ///< format of a scene from stdin
  std::string absorption;  ///< three numbers; empty: none
  LightOptions light;
  std::vector<std::string> translucent;  ///< MATERIAL=T
  int max_depth = SolveOptions().max_depth;
  bool json = false;
  bool form_factors = false;
  std::size_t pairs = 50, faces = 100;
  std::uint64_t seed = 1;
};

void explain_plan(const ExplainCommand& command, const Scene& scene) {
  const BaseMesh mesh(scene);
  if (mesh.roots().empty()) throw Failure(ExitStatus::bad_scene, name_of(command.scene) + ": no face has any area");
  const Plan plan(mesh, {.max_depth = command.max_depth});
  if (command.json) std::cout << json_of(plan.features()).dump(2, ' ', false, nlohmann::json::error_handler_t::replace) << '\n';
  else std::cout << table_of(plan.features());
}

void explain_form_factors(const ExplainCommand& command, const Scene& scene) {
  std::cout << "law          method    checked  rms        worst\n";
  for (const FormFactorCheck& check : check_form_factors(scene, command.pairs, command.faces, command.seed)) {
    char line[100];
    std::snprintf(line, sizeof line, "%-12.*s %-9.*s %-8zu %-10.2g %.2g\n", static_cast<int>(check.law.size()), check.law.data(),
                  static_cast<int>(check.method.size()), check.method.data(), check.count, check.rms, check.worst);
    std::cout << line;
  }
  std::cout
      << "reciprocity and additivity are relative; closure is what row sums lack of 1, which in an open scene is what escapes\n";
}

void run_explain(const ExplainCommand& command) {
  require_inputs({{InputKind::scene, command.scene}}, command.format);
  SceneImport import;
  take_light_options(command.light, import);
  take_translucent(command.translucent, import.options);
  SceneFile file = read_scene(command.scene, command.format, import);
  take_absorption(command.absorption, file.scene);
  warn(file.warnings);
  if (command.form_factors) explain_form_factors(command, file.scene);
  else explain_plan(command, file.scene);
}

}  // namespace

void add_explain_command(CLI::App& app) {
  const auto options = std::make_shared<ExplainCommand>();
  CLI::App& command = *app.add_subcommand("explain", "Show which solver features a scene needs, and why");
  command.add_option("scene", options->scene, "A scene file; - is stdin")->required()->type_name("SCENE");
  add_format_option(command, options->format);
  command.add_flag("--json", options->json, "Print the plan as a JSON array");
  command.add_option("--max-depth", options->max_depth, "Most levels of subdivision of the solve (12)")
      ->check(CLI::Range(0, PatchId::max_level));
  add_absorption_option(command, options->absorption);
  add_light_options(command, options->light);
  add_translucent_option(command, options->translucent);
  command.add_flag("--form-factors", options->form_factors,
                   "Check reciprocity, additivity and closure of form factors instead of showing the plan");
  command.add_option("--pairs", options->pairs, "Number of random pairs of faces to check (50)");
  command.add_option("--faces", options->faces, "Number of faces whose row sums are checked (100)");
  command.add_option("--seed", options->seed, "The same seed checks the same pairs (1)");
  command.callback([options] { run_explain(*options); });
}

}  // namespace alvor
