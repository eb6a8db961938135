#pragma once
// Prints a plan for people and for programs.

#include "solution/feature.h"

#include <nlohmann/json_fwd.hpp>

#include <span>
#include <string>

namespace alvor {

/// Returns a line for each feature: on or off, why, and what that costs or saves.
std::string table_of(std::span<const PlannedFeature> plan);

/// Returns an array of objects with the keys feature, on, reason, cost.
nlohmann::ordered_json json_of(std::span<const PlannedFeature> plan);

}  // namespace alvor
