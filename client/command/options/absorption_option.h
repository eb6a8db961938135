#pragma once
// The option for a medium, which scene files cannot hold.

#include "meshing/scene.h"

#include <CLI/CLI.hpp>

#include <string>

namespace alvor {

/// Adds `--absorption`. `absorption` is set to three numbers, or stays empty.
void add_absorption_option(CLI::App& command, std::string& absorption);

/// Sets the scene's absorption, unless `absorption` is empty. Throws Failure (usage) if a number is negative.
void take_absorption(const std::string& absorption, Scene& scene);

}  // namespace alvor
