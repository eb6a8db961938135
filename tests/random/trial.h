#pragma once
// A random scene and the options to solve it with.

#include "meshing/scene.h"
#include "radiosity/solve/solver.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace alvor::test {

struct Trial {
  std::uint64_t seed = 0;
  Scene scene;
  SolveOptions options;
  /// Whether no two faces overlap in one plane. Where they do, the light between them depends on which of them a ray hits first.
  bool is_well_posed = true;
  /// The place that a refusal must name; empty if the scene has no fault.
  std::optional<std::string> faulty_place;
};

/// Returns the trial for a seed, always the same: 1 to about 60 faces, mostly nasty.
Trial random_trial(std::uint64_t seed);

struct Solved {
  SolveOutcome outcome;
  std::vector<LeafValue> leaves;
  std::vector<Step> steps;
};

/// Solves the mesh. Requires: it has roots.
Solved solved(const BaseMesh& mesh, const SolveOptions& options);

}  // namespace alvor::test
