#pragma once
// The bytes that tell other ranks what to solve.

#include "meshing/edit/edited_scene.h"
#include "meshing/scene.h"
#include "radiosity/plan/solve_options.h"

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace alvor {

/// A solve as the first rank orders it from the others.
struct SolveOrder {
  SolveOptions options;          ///< without the pause between steps, which is the first rank's
  std::vector<char> checkpoint;  ///< SolveControl::checkpoint
  Scene submitted;
  std::optional<Scene> edited;  ///< what edits have made of it, if there are any
  AddedScenes added;            ///< the scenes that they have added to it
};

/// Returns the bytes of an order. `edited` is null if there are no edits.
std::vector<std::byte> bytes_of_order(const SolveOptions& options, std::span<const std::byte> checkpoint, const Scene& submitted,
                                      const Scene* edited, const AddedScenes& added = {});
/// Reads what bytes_of_order() of the same program returned. Throws BadBytes or runtime_error.
SolveOrder read_order(std::span<const std::byte> bytes);

}  // namespace alvor
