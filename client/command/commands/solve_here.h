#pragma once
// Solves a scene in the process of the command, for commands that need a solution on the way to something else.

#include "meshing/display_mesh.h"
#include "radiosity/solve/solver.h"

#include <CLI/CLI.hpp>

#include <array>
#include <string>
#include <string_view>

namespace alvor {

/// The options that add_solve_limits() adds.
inline constexpr std::array solve_limits{"--tolerance", "--max-elements", "--time-limit", "--threads", "--seed"};
/// Adds the options for how far a scene is solved.
void add_solve_limits(CLI::App& command, SolveOptions& options);

/// A solution, and why it ended if that was before its tolerance.
struct SolvedHere {
  DisplayMesh mesh;
  std::string unfinished;  ///< one sentence, or empty
};

/// Returns the sentence that says why a solve ended before its tolerance, by the reason that it gave (text(StopReason)); nothing
/// if it reached it.
std::string why_unfinished(std::string_view end_reason, double estimated_error);

/// Solves a scene, which messages call `name`, and shows how far it is. Warns if the solve ends before its tolerance. Throws
/// Failure if it is cancelled or no face has an area.
SolvedHere solve_here(const Scene& scene, const SolveOptions& options, const std::string& name);

}  // namespace alvor
