#pragma once
// Which axis points up, as an option says: many scene files do not.

#include "meshing/scene.h"

#include <CLI/CLI.hpp>

#include <string>

namespace alvor {

/// Adds `--up y|z` to a command that reads a scene file and draws. `up` gets the axis, or stays empty.
void add_up_option(CLI::App& command, std::string& up);

/// Returns whether `up` names an axis and not a direction in numbers.
bool is_axis(const std::string& up);

/// Sets `axis` to the one that `up` names; leaves it as it is where `up` names none.
void take_up(const std::string& up, UpAxis& axis);

}  // namespace alvor
