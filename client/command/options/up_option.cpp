#include "client/command/options/up_option.h"

namespace alvor {

void add_up_option(CLI::App& command, std::string& up) {
  command.add_option("--up", up, "Axis that points up (z for STL, PLY and 3DS, the file's own for FBX, else y)")
      ->type_name("y|z")
      ->check(CLI::IsMember({"y", "z"}));
}

bool is_axis(const std::string& up) { return up == "y" || up == "z"; }

void take_up(const std::string& up, UpAxis& axis) {
  if (is_axis(up)) axis = up == "z" ? UpAxis::z : UpAxis::y;
}

}  // namespace alvor
