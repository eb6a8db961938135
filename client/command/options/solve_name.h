#pragma once
// Names of solves: scenes/SCENE/solves/SOLVE.

#include <string>

namespace alvor {

/// Returns whether `text` has the form of a solve's name.
bool is_solve_name(const std::string& text);

/// Returns the name of the solve's scene. Throws Failure (usage) if `solve` is not the name of a solve.
std::string scene_name_of(const std::string& solve);

}  // namespace alvor
