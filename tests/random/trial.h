#pragma once
// A random scene and how to solve it.

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
  /// Each point of a surface has one front and sees what is in front of it: no face lies in another's plane where they overlap.
  /// Elsewhere light between such faces depends on which of them a ray finds first.
  bool is_well_posed = true;
  /// The place that a refusal must name; nothing: the scene has no fault.
  std::optional<std::string> faulty_place;
};

/// The same trial from the same seed: 1 to some 60 faces, mostly nasty.
Trial random_trial(std::uint64_t seed);

struct Solved {
  SolveOutcome outcome;
  std::vector<LeafValue> leaves;
  std::vector<Step> steps;
};

/// Requires: roots.
Solved solved(const BaseMesh& mesh, const SolveOptions& options);

}  // namespace alvor::test
