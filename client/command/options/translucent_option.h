#pragma once
// The option that makes materials of a scene file translucent.

#include "alvor/v1/scene_service.pb.h"

#include <CLI/CLI.hpp>

#include <span>
#include <string>
#include <vector>

namespace alvor {

/// Adds `--translucent`. `translucent` gets the texts as they are given, each MATERIAL=T or MATERIAL=r,g,b.
void add_translucent_option(CLI::App& command, std::vector<std::string>& translucent);

/// Appends what the texts say to the options. Throws Failure (usage) for a text that is not as above, and for numbers outside
/// [0, 1].
void take_translucent(std::span<const std::string> translucent, v1::ImportOptions& options);

}  // namespace alvor
