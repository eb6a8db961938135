#pragma once
// Test scenes that do not need some feature.

#include "meshing/scene.h"
#include "radiosity/solve/solver.h"

#include <string>
#include <vector>

namespace alvor::bench {

struct PlanCase {
  std::string name;  ///< one word
  std::string what;  ///< description for people
  Scene scene;
  SolveOptions options;
  /// The features that the plan switches off, and that are forced on together for comparison; empty for the general scene.
  FeatureSet features;
};

std::vector<PlanCase> plan_cases();

}  // namespace alvor::bench
