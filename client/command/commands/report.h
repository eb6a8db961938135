#pragma once
// What is said about a solve: to scripts, to spreadsheets and to people.

#include "client/command/commands/follow.h"

#include <span>
#include <string>
#include <vector>

namespace alvor {

/// CSV: a header and a line per step, oldest first.
std::string step_table(std::span<const Step> steps);

/// One JSON object: the outcome of the solve and the warnings about its scene.
std::string outcome_json(const Followed& followed, std::span<const std::string> warnings);

/// One line for people: leaves, rays, seconds, estimated error, why it ended.
std::string summary(const Followed& followed);

}  // namespace alvor
