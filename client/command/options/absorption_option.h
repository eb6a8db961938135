#pragma once
// A medium, as an option says: scene files have none.

#include "meshing/scene.h"

#include <CLI/CLI.hpp>

#include <string>

namespace alvor {

/// `absorption` gets three numbers, or stays empty.
void add_absorption_option(CLI::App& command, std::string& absorption);

/// Leaves the scene as it is if `absorption` is empty. Throws Failure (usage) if a number is negative.
void take_absorption(const std::string& absorption, Scene& scene);

}  // namespace alvor
