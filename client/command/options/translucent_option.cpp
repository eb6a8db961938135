#include "client/command/options/translucent_option.h"

#include "client/command/output/failure.h"
#include "client/command/output/numbers.h"
#include "proto/codec.h"

namespace alvor {

namespace {

v1::TranslucentMaterial parsed(const std::string& text) {
  const auto equals = text.rfind('=');  // names of materials may hold one
  if (equals != text.npos && equals > 0) {
    const std::string numbers = text.substr(equals + 1);
    auto bands = parse_numbers(numbers, 3);
    if (const auto one = parse_numbers(numbers, 1)) bands = std::vector<double>(3, (*one)[0]);
    const Rgb transmittance = bands ? Rgb{(*bands)[0], (*bands)[1], (*bands)[2]} : Rgb{-1, -1, -1};
    if (transmittance.min() >= 0 && transmittance.max() <= 1) {
      v1::TranslucentMaterial material;
      material.set_material(text.substr(0, equals));
      *material.mutable_diffuse_transmittance() = encode(transmittance);
      return material;
    }
  }
  throw Failure(ExitStatus::usage, "--translucent: '" + text + "' is not MATERIAL=T or MATERIAL=r,g,b with numbers in [0, 1]");
}

}  // namespace

void add_translucent_option(CLI::App& command, std::vector<std::string>& translucent) {
  command
      .add_option(
          "--translucent", translucent,
          "Let a material scatter this share of light behind it, as cloth and paper do: one number, or one for each band; "
          "any number of times")
      ->type_name("MATERIAL=T")
      ->allow_extra_args(false);
}

void take_translucent(std::span<const std::string> translucent, v1::ImportOptions& options) {
  for (const std::string& text : translucent) *options.add_translucent() = parsed(text);
}

}  // namespace alvor
