// alvor explain SCENE: what the solver makes of a scene.

#include "client/command/commands.h"
#include "client/command/failure.h"
#include "client/command/outputs.h"
#include "client/scene_file.h"
#include "radiosity/form_factor_checks.h"

#include <cstdio>
#include <iostream>
#include <memory>

namespace alvor {

namespace {

struct ExplainCommand {
  std::filesystem::path scene;
  bool form_factors = false;
  std::size_t pairs = 50, faces = 100;
  std::uint64_t seed = 1;
};

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
  if (!command.form_factors) throw Failure(ExitStatus::usage, "nothing to explain: say --form-factors");
  const SceneFile file = read_scene_file(command.scene);
  warn(file.warnings);
  explain_form_factors(command, file.scene);
}

}  // namespace

void add_explain_command(CLI::App& app) {
  const auto options = std::make_shared<ExplainCommand>();
  CLI::App& command = *app.add_subcommand("explain", "What the solver makes of a scene");
  command.add_option("scene", options->scene, "A scene file")->required()->type_name("SCENE");
  command.add_flag("--form-factors", options->form_factors, "Measure reciprocity, additivity and closure");
  command.add_option("--pairs", options->pairs, "Pairs of faces to check, taken at random (50)");
  command.add_option("--faces", options->faces, "Faces whose row sums to check (100)");
  command.add_option("--seed", options->seed, "The same seed checks the same pairs (1)");
  command.callback([options] { run_explain(*options); });
}

}  // namespace alvor
