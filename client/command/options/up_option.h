#pragma once
// The option for the axis that points up, which many scene files do not say.

#include "meshing/scene.h"

#include <CLI/CLI.hpp>

#include <string>

namespace alvor {

/// Adds `--up y|z` to a command that reads a scene file and draws. `up` is set to the axis, or stays empty.
void add_up_option(CLI::App& command, std::string& up);

/// Returns whether `up` names an axis (and not a direction in numbers).
bool is_axis(const std::string& up);

/// Sets `axis` to the axis that `up` names; leaves it unchanged if `up` names none.
void take_up(const std::string& up, UpAxis& axis);

}  // namespace alvor
