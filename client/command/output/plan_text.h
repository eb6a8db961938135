#pragma once
// A plan, for people and for programs.

#include "solution/feature.h"

#include <nlohmann/json_fwd.hpp>

#include <span>
#include <string>

namespace alvor {

/// A line for each feature: on or off, why, and what that costs or saves.
std::string table_of(std::span<const PlannedFeature> plan);

/// An array of objects with the keys feature, on, reason, cost.
nlohmann::ordered_json json_of(std::span<const PlannedFeature> plan);

}  // namespace alvor
