#pragma once
// Reports about a solve: for scripts, spreadsheets and people.

#include "client/command/commands/follow.h"

#include <span>
#include <string>
#include <vector>

namespace alvor {

/// Returns a CSV text: a header and one line per step, oldest first.
std::string step_table(std::span<const Step> steps);

/// Returns one JSON object: the outcome of the solve and the warnings about its scene.
std::string outcome_json(const Followed& followed, std::span<const std::string> warnings);

/// Returns one line for people: leaves, rays, seconds, estimated error, why it ended.
std::string summary(const Followed& followed);

}  // namespace alvor
