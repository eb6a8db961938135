// alvor luminaire FILE: says what a photometric file holds, and draws its polar curves.

#include "client/command/commands/commands.h"
#include "client/command/options/luminaire_option.h"
#include "client/command/output/failure.h"
#include "client/command/output/notes.h"
#include "client/command/output/numbers.h"
#include "client/command/output/output_file.h"
#include "client/picture/polar_plot.h"
#include "client/picture/units.h"

#include <nlohmann/json.hpp>

#include <array>
#include <memory>

namespace alvor {

namespace {

struct LuminaireCommand {
  std::filesystem::path file;
  OutputFile picture;
  bool json = false;
};

std::string opening_text(const LuminousOpening& opening) {
  using Shape = LuminousOpening::Shape;
  std::string text = name_of(opening.shape);
  if (opening.shape == Shape::point) return text;
  text += ", " + shortest(opening.across) + " m";
  if (opening.shape == Shape::sphere) return text;
  text += " along C0 x " + shortest(opening.along) + " m along C90";
  return opening.height > 0 ? text + ", " + shortest(opening.height) + " m high" : text;
}

std::string range_text(std::span<const double> angles) {
  return std::to_string(angles.size()) + ", " + shortest(angles.front()) + " to " + shortest(angles.back()) + " degrees";
}

std::string rounded(double value, const char* unit) {
  char text[48];
  std::snprintf(text, sizeof text, "%.4g %s", value, unit);
  return text;
}

std::string text_of(const LuminaireFile& file) {
  std::string text;
  const auto line = [&](std::string name, const std::string& value) {
    name.resize(16, ' ');
    text += name + value + '\n';
  };
  line("luminaire", file.name.empty() ? "without a name" : file.name);
  line("format", file.format + ", type " + file.type);
  line("lumens", rounded(file.lumens, "lm") + " (integral of the intensities)");
  if (file.stated_lumens) line("stated lumens", rounded(*file.stated_lumens, "lm"));
  if (file.lamp_lumens) {
    line("lamps", rounded(*file.lamp_lumens, "lm"));
    if (*file.lamp_lumens > 0) line("light output", percent(file.lumens / *file.lamp_lumens) + " of the lamps' lumens");
  } else {
    line("photometry", "absolute: the lumens of the lamps are not stated");
  }
  line("watts", file.watts > 0 ? rounded(file.watts, "W") : "not stated");
  if (file.watts > 0) line("efficacy", rounded(file.lumens / file.watts, "lm/W"));
  line("greatest", rounded(file.web->greatest(), "cd"));
  line("symmetry", file.symmetry);
  line("planes", range_text(file.web->planes));
  line("angles", range_text(file.web->angles));
  line("opening", opening_text(file.opening));
  return text;
}

std::string json_of(const LuminaireFile& file) {
  const auto or_null = [](const std::optional<double>& value) { return value ? nlohmann::ordered_json(*value) : nullptr; };
  nlohmann::ordered_json json;
  json["name"] = file.name;
  json["format"] = file.format;
  json["photometry_type"] = std::string(1, file.type);
  json["lumens"] = file.lumens;
  json["stated_lumens"] = or_null(file.stated_lumens);
  json["lamp_lumens"] = or_null(file.lamp_lumens);
  json["watts"] = file.watts > 0 ? nlohmann::ordered_json(file.watts) : nullptr;
  json["lumens_per_watt"] = file.watts > 0 ? nlohmann::ordered_json(file.lumens / file.watts) : nullptr;
  json["greatest_candela"] = file.web->greatest();
  json["symmetry"] = file.symmetry;
  json["planes"] = file.web->planes.size();
  json["angles"] = file.web->angles.size();
  json["opening"] = {{"shape", name_of(file.opening.shape)},
                     {"across_m", file.opening.across},
                     {"along_m", file.opening.along},
                     {"height_m", file.opening.height}};
  json["warnings"] = file.warnings;
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + '\n';
}

void run_luminaire(const LuminaireCommand& command) {
  require_output(command.picture, picture_kind, "--output");
  reserve_stdout_for({command.picture.path});
  const LuminaireFile file = read_luminaire_file(command.file);
  warn(file.warnings);
  if (command.json) results() << json_of(file);
  else results() << text_of(file);
  if (!command.picture.path.empty()) write_picture(command.picture.path, draw_polar_curves(file));
}

}  // namespace

void add_luminaire_command(CLI::App& app) {
  const auto options = std::make_shared<LuminaireCommand>();
  CLI::App& command = *app.add_subcommand("luminaire", "Describe a photometric file (IES LM-63, EULUMDAT)");
  command.add_option("file", options->file, "A file .ies or .ldt")->required()->type_name("FILE");
  command.add_flag("--json", options->json, "Print one JSON object instead of text");
  add_output_option(command, options->picture, picture_kind, "Draw the polar curves: .png")->type_name("POLAR");
  command.callback([options] { run_luminaire(*options); });
}

}  // namespace alvor
