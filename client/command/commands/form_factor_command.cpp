// alvor form-factor SCENE A B: prints the form factor from one face to another, by every method.

#include "client/command/commands/commands.h"
#include "client/command/commands/outputs.h"
#include "client/command/options/input_file.h"
#include "client/command/output/failure.h"
#include "client/command/output/files.h"
#include "client/command/output/notes.h"
#include "client/command/output/numbers.h"
#include "radiosity/form_factors/face_form_factor.h"

#include <cstdio>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

namespace alvor {

namespace {

struct FormFactorCommand {
  std::filesystem::path scene;
  std::string format;  ///< format of a scene from stdin
  std::uint32_t from = 0, to = 0;
  bool json = false;
  FormFactorOptions options;
};

std::string table(std::span<const MeasuredFormFactor> measured) {
  std::string text = "method    form factor        error bound  rays       time\n";
  for (const MeasuredFormFactor& m : measured) {
    char line[120];
    std::snprintf(line, sizeof line, "%-9.*s %-18.12g %-12.2g %-10llu %s\n", static_cast<int>(m.method.size()), m.method.data(),
                  m.value, m.error_bound, static_cast<unsigned long long>(m.rays), seconds(m.seconds).c_str());
    text += line;
  }
  return text;
}

std::string json_of(std::span<const MeasuredFormFactor> measured) {
  auto list = nlohmann::ordered_json::array();
  for (const MeasuredFormFactor& m : measured)
    list.push_back(
        {{"method", m.method}, {"value", m.value}, {"error_bound", m.error_bound}, {"rays", m.rays}, {"seconds", m.seconds}});
  return list.dump(2) + "\n";
}

void require_face(const FormFactorCommand& command, const Scene& scene, const FaceFormFactors& form_factors, std::uint32_t face) {
  if (face >= scene.faces.size())
    throw Failure(ExitStatus::usage, "face " + std::to_string(face) + ": the scene has " + std::to_string(scene.faces.size()) +
                                         " faces, numbered from 0");
  if (form_factors.faces().pieces(face).empty())
    throw Failure(ExitStatus::bad_scene, name_of(command.scene) + ": face " + std::to_string(face) +
                                             ": has no area, or lies in the place of another face");
}

void run_form_factor(const FormFactorCommand& command) {
  require_inputs({{InputKind::scene, command.scene}}, command.format);
  const SceneFile file = read_scene(command.scene, command.format);
  warn(file.warnings);
  const FaceFormFactors form_factors(file.scene, command.options);
  for (const std::uint32_t face : {command.from, command.to}) require_face(command, file.scene, form_factors, face);
  const auto measured = form_factors.by_all_methods(command.from, command.to);
  std::cout << (command.json ? json_of(measured) : table(measured));
}

}  // namespace

void add_form_factor_command(CLI::App& app) {
  const auto options = std::make_shared<FormFactorCommand>();
  CLI::App& command = *app.add_subcommand("form-factor", "Compute the form factor between two faces by every method");
  command.add_option("scene", options->scene, "A scene file; - is stdin")->required()->type_name("SCENE");
  add_format_option(command, options->format);
  command.add_option("from", options->from, "Number of the sending face, in file order from 0")->required()->type_name("A");
  command.add_option("to", options->to, "Number of the receiving face, in file order from 0")->required()->type_name("B");
  command.add_flag("--json", options->json, "Print a JSON list instead of a table");
  command
      .add_option("--accuracy", options->options.accuracy,
                  "Relative accuracy of the analytic method where faces block the view (0.0001)")
      ->check(CLI::Range(1e-9, 1.0));
  command.add_option("--rays", options->options.nusselt_rays, "Number of rays of the Nusselt method (262144)")
      ->check(CLI::Range(1024, 1 << 28));
  command
      .add_option("--resolution", options->options.hemicube_resolution,
                  "Number of cells along a side of the hemicube's top, even (32)")
      ->check(CLI::Range(2, 2048));
  command.add_option("--seed", options->options.seed, "The same seed sends the same rays (1)");
  command.callback([options] {
    options->options.hemicube_resolution += options->options.hemicube_resolution % 2;
    run_form_factor(*options);
  });
}

}  // namespace alvor
