#include "client/command/options/false_colour_options.h"

#include "client/command/output/failure.h"
#include "client/command/output/notes.h"
#include "client/command/output/numbers.h"
#include "client/picture/legend.h"

#include <array>
#include <map>

namespace alvor {

namespace {

const std::map<std::string, Band> bands{{"mean", Band::mean}, {"r", Band::red}, {"g", Band::green}, {"b", Band::blue}};

ColourScale scale_of(const FalseColourOptions& options) {
  const auto ends = parse_numbers(options.range, 2);
  if (!ends || !((*ends)[0] < (*ends)[1]))
    throw Failure(ExitStatus::usage, "--range " + options.range + " is not two numbers, the lower one first, like 0,5");
  if (options.logarithmic && !((*ends)[0] > 0))
    throw Failure(ExitStatus::usage, "--range " + options.range + ": a logarithmic scale begins above 0");
  return {(*ends)[0], (*ends)[1], options.logarithmic};
}

void warn_of_no_room(PictureSize size) {
  const std::string picture = std::to_string(size.width) + " x " + std::to_string(size.height) + " pixels";
  warn(std::array{"the picture has no legend: " + picture + " are too few for one"});
}

}  // namespace

void add_false_colour_options(CLI::App& command, FalseColourOptions& options, CLI::Option& exposure) {
  CLI::Option* wanted = command.add_flag("--false-colour,--false-color", options.wanted,
                                         "Colour surfaces by irradiance, with a legend in W/m2 or lx");
  CLI::Option* shown =
      command.add_option("--show", options.shown, "Colour surfaces by irradiance, or by the error that the solution tells of it");
  shown->type_name("WHAT")->check(CLI::IsMember({"irradiance", "error"}))->excludes(wanted);
  exposure.excludes(wanted)->excludes(shown);
  command.add_option("--band", options.band, "Band whose irradiance is shown (the mean of all three)")
      ->type_name("BAND")
      ->check(CLI::IsMember({"r", "g", "b", "mean"}));
  command
      .add_option("--range", options.range,
                  "Ends of the colour scale, W/m2 or lx (from 0 to a round number that suits the picture)")
      ->type_name("LOW,HIGH");
  command.add_flag("--log-scale", options.logarithmic, "Use a logarithmic colour scale");
}

std::optional<FalseColour> false_colour_of(const FalseColourOptions& options, PictureSize size) {
  if (!options.wanted && options.shown.empty()) {
    if (options.band == "mean" && options.range.empty() && !options.logarithmic) return std::nullopt;
    throw Failure(ExitStatus::usage, "--band, --range and --log-scale require --false-colour or --show");
  }
  const Shown shown = options.shown == "error" ? Shown::error : Shown::irradiance;
  FalseColour chosen{bands.at(options.band), std::nullopt, options.logarithmic, legend_fits(size), shown};
  if (!options.range.empty()) chosen.scale = scale_of(options);
  if (!chosen.legend) warn_of_no_room(size);
  return chosen;
}

}  // namespace alvor
