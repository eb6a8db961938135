#include "client/command/options/edit_option.h"

#include "client/command/options/luminaire_option.h"
#include "client/command/output/failure.h"
#include "proto/codec.h"

#include <google/protobuf/util/json_util.h>

#include <charconv>
#include <fstream>
#include <numbers>
#include <regex>
#include <span>
#include <sstream>
#include <system_error>
#include <utility>
#include <vector>

namespace alvor {

namespace {

/// `PART:NAME` and what is to be set of it.
struct Named {
  std::string part, name, value;
};

[[noreturn]] void refuse(const std::string& option, const std::string& text, const std::string& reason) {
  throw Failure(ExitStatus::usage, option + " '" + text + "': " + reason);
}

/// Names may contain colons, dots and signs of equality: the first colon and the last '=' count. `form`: how the text must be.
Named split(const std::string& option, const std::string& text, const std::string& form) {
  const auto colon = text.find(':'), equals = text.rfind('=');
  if (colon == std::string::npos || equals == std::string::npos || equals < colon) refuse(option, text, "must be " + form);
  return {text.substr(0, colon), text.substr(colon + 1, equals - colon - 1), text.substr(equals + 1)};
}

/// `NAME=VALUE` of an object: the last '=' counts.
Named split_object(const std::string& option, const std::string& text) {
  const auto equals = text.rfind('=');
  if (equals == std::string::npos) refuse(option, text, "must be NAME=VALUE, with the name of an object");
  return {"object", text.substr(0, equals), text.substr(equals + 1)};
}

v1::Edit edit_of_object(const std::string& name) {
  v1::Edit edit;
  edit.mutable_object()->set_name(name);
  return edit;
}

std::vector<double> numbers_of(const std::string& option, const std::string& text, const std::string& value, std::size_t count) {
  std::vector<double> numbers;
  const char *at = value.data(), *const end = at + value.size();
  while (at < end) {
    double number = 0;
    const auto [after, fault] = std::from_chars(at, end, number);
    if (fault != std::errc()) break;
    numbers.push_back(number);
    at = after;
    if (at < end && *at != ',') break;
    if (at < end) ++at;
  }
  if (at != end || numbers.size() != count || value.ends_with(','))
    refuse(option, text,
           count == 1   ? "the value must be a number"
           : count == 2 ? "the value must be two numbers with a comma between them"
                        : "the value must be three numbers with commas between them");
  return numbers;
}

/// Requires: three numbers.
void set_vector(std::span<const double> numbers, v1::Vector3& vector) {
  vector.set_x(numbers[0]), vector.set_y(numbers[1]), vector.set_z(numbers[2]);
}

}  // namespace

v1::Edit edit_of_setting(const std::string& setting) {
  const std::string option = "--set";
  Named named = split(option, setting, "material:NAME.FIELD=VALUE or light:NAME.FIELD=VALUE");
  const auto dot = named.name.rfind('.');
  if (dot == std::string::npos) refuse(option, setting, "names no field: PART:NAME.FIELD=VALUE");
  const std::string field = named.name.substr(dot + 1);
  named.name.resize(dot);
  const auto three = [&] { return numbers_of(option, setting, named.value, 3); };
  const auto set_colour = [&](v1::Rgb& colour) {
    const auto n = three();
    colour.set_r(n[0]), colour.set_g(n[1]), colour.set_b(n[2]);
  };
  const auto set_cone = [&](v1::SpotCone& cone) {
    const auto degrees = numbers_of(option, setting, named.value, 2);
    cone.set_inner_radians(degrees[0] * std::numbers::pi / 180), cone.set_outer_radians(degrees[1] * std::numbers::pi / 180);
  };
  const auto set = [&](v1::Vector3& vector) { set_vector(three(), vector); };
  v1::Edit edit;
  if (named.part == "material") {
    v1::MaterialEdit& material = *edit.mutable_material();
    material.set_name(named.name);
    if (field == "emission") set_colour(*material.mutable_emission());
    else if (field == "reflectance") set_colour(*material.mutable_reflectance());
    else if (field == "diffuse_transmittance") set_colour(*material.mutable_diffuse_transmittance());
    else if (field == "regular_transmittance") set_colour(*material.mutable_regular_transmittance());
    else refuse(option, setting, "a material has the fields emission, reflectance, diffuse_transmittance, regular_transmittance");
  } else if (named.part == "light") {
    v1::LightEdit& light = *edit.mutable_light();
    light.set_name(named.name);
    if (field == "intensity") set_colour(*light.mutable_intensity());
    else if (field == "position") set(*light.mutable_position());
    else if (field == "direction") set(*light.mutable_direction());
    else if (field == "cone") set_cone(*light.mutable_cone());
    else refuse(option, setting, "a light has the fields intensity, position, direction, cone");
  } else {
    refuse(option, setting, "the part must be material or light");
  }
  return edit;
}

v1::Edit edit_of_dim(const std::string& dim) {
  const std::string option = "--dim";
  const Named named = split(option, dim, "light:NAME=FACTOR or object:NAME=FACTOR");
  const double factor = numbers_of(option, dim, named.value, 1)[0];
  v1::Edit edit;
  if (named.part == "light") {
    edit.mutable_light()->set_name(named.name);
    edit.mutable_light()->set_dim(factor);
  } else if (named.part == "object") {
    edit.mutable_object()->set_name(named.name);
    edit.mutable_object()->set_dim(factor);
  } else {
    refuse(option, dim, "the part must be light or object");
  }
  return edit;
}

v1::Edit edit_of_web(const std::string& web) {
  const auto equals = web.find('=');
  if (equals == std::string::npos) refuse("--web", web, "must be NAME=FILE, with the name of a luminaire");
  v1::Edit edit;
  edit.mutable_light()->set_name(web.substr(0, equals));
  *edit.mutable_light()->mutable_web() = encode(*read_luminaire_file(web.substr(equals + 1)).web);
  return edit;
}

v1::Edit edit_of_absorption(const std::string& absorption) {
  const auto n = numbers_of("--absorption", absorption, absorption, 3);
  v1::Edit edit;
  *edit.mutable_medium()->mutable_absorption_per_meter() = encode(Rgb{n[0], n[1], n[2]});
  return edit;
}

v1::Edit edit_of_copy(const std::string& copy) {
  const Named named = split_object("--copy", copy);
  v1::Edit edit;
  edit.mutable_copy()->set_name(named.name);
  edit.mutable_copy()->set_of(named.value);
  return edit;
}

v1::Edit edit_of_addition(const std::string& addition) {
  const auto equals = addition.find('=');
  if (equals == std::string::npos || equals + 1 == addition.size())
    refuse("--add", addition, "must be NEW=FILE or NEW=scenes/SCENE, with the name of a new object");
  v1::Edit edit;
  edit.mutable_copy()->set_name(addition.substr(0, equals));
  edit.mutable_copy()->set_scene(addition.substr(equals + 1));
  return edit;
}

v1::Edit edit_of_move(const std::string& move) {
  const Named named = split_object("--move", move);
  v1::Edit edit = edit_of_object(named.name);
  set_vector(numbers_of("--move", move, named.value, 3), *edit.mutable_object()->mutable_move());
  return edit;
}

v1::Edit edit_of_turn(const std::string& turn) {
  const Named named = split_object("--turn", turn);
  v1::Edit edit = edit_of_object(named.name);
  const bool has_axis = named.value.find(',') != std::string::npos;
  const auto n = numbers_of("--turn", turn, named.value, has_axis ? 4 : 1);
  edit.mutable_object()->set_turn(n[0]);
  if (has_axis) set_vector(std::span(n).subspan(1), *edit.mutable_object()->mutable_turn_axis());
  return edit;
}

v1::Edit edit_of_scale(const std::string& scale) {
  const Named named = split_object("--scale", scale);
  v1::Edit edit = edit_of_object(named.name);
  edit.mutable_object()->set_scale(numbers_of("--scale", scale, named.value, 1)[0]);
  return edit;
}

v1::Edit edit_of_hidden(const std::string& name, bool hidden) {
  v1::Edit edit = edit_of_object(name);
  edit.mutable_object()->set_hidden(hidden);
  return edit;
}

namespace {

/// Returns what the parser of JSON says of a script, in words for those who do not know protobuf. Long texts are cut off.
std::string plain_words(std::string message) {
  constexpr std::size_t longest = 300;
  static const std::pair<std::regex, const char*> wordings[]{
      {std::regex(R"(\((.*)\): invalid value (.*) for type TYPE_(DOUBLE|FLOAT))"), "$1: $2 is no number"},
      {std::regex(R"(\((.*)\): invalid value (.*) for type TYPE_U?INT(32|64))"), "$1: $2 is no whole number"},
      {std::regex(R"(\((.*)\): invalid value (.*) for type TYPE_BOOL)"), "$1: $2 is neither true nor false"},
      {std::regex(R"(\((.*)\): invalid value (.*) for type TYPE_STRING)"), "$1: $2 is no text"},
      {std::regex(R"(\((.*)\): invalid value (.*) for type type\.googleapis\.com/.*)"), "$1: $2 is none of its values"},
      {std::regex(R"(\((.*)\): invalid value oneof .* Cannot set '(.*)' for type oneof)"),
       "$1: '$2' is a second part; an edit has one"},
      {std::regex(R"(\((.*)\) (.*): Cannot find field\.)"), "$1: there is no field '$2'"},
      {std::regex(R"(\((.*)\) (.*): Proto field is not repeating, cannot start list\.)"), "$1: '$2' is no list"}};
  if (message.size() > longest) return message.substr(0, longest) + "...";
  for (const auto& [pattern, words] : wordings)
    if (std::regex_match(message, pattern)) return std::regex_replace(message, pattern, words);
  return message;
}

}  // namespace

v1::EditStep step_of_script(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  if (!file) throw Failure(ExitStatus::usage, "--script " + path + ": cannot be read");
  v1::EditStep step;
  const auto status = google::protobuf::util::JsonStringToMessage(text.str(), &step);
  if (!status.ok()) throw Failure(ExitStatus::usage, "--script " + path + ": " + plain_words(std::string(status.message())));
  return step;
}

}  // namespace alvor
