#pragma once
// Scenes that can do without a feature.

#include "meshing/scene.h"
#include "radiosity/solve/solver.h"

#include <string>
#include <vector>

namespace alvor::bench {

struct PlanCase {
  std::string name;  ///< one word
  std::string what;  ///< for people
  Scene scene;
  SolveOptions options;
  FeatureSet features;  ///< that the plan switches off and that are forced on together, for comparison; empty: the general scene
};

std::vector<PlanCase> plan_cases();

}  // namespace alvor::bench
