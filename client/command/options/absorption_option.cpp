#include "client/command/options/absorption_option.h"

#include "client/command/options/option_checks.h"
#include "client/command/output/failure.h"
#include "client/command/output/numbers.h"

namespace alvor {

void add_absorption_option(CLI::App& command, std::string& absorption) {
  command.add_option("--absorption", absorption, "Absorption coefficient of a medium that fills the scene, 1/m per band (0,0,0)")
      ->type_name("R,G,B")
      ->check(triple());
}

void take_absorption(const std::string& absorption, Scene& scene) {
  const auto bands = parse_numbers(absorption, 3);
  if (!bands) return;
  scene.absorption = {(*bands)[0], (*bands)[1], (*bands)[2]};
  if (scene.absorption.min() < 0) throw Failure(ExitStatus::usage, "--absorption: " + absorption + " has a negative number");
}

}  // namespace alvor
