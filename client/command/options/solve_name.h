#pragma once
// Names of solves, as scenes/SCENE/solves/SOLVE.

#include <string>

namespace alvor {

/// By its form alone.
bool is_solve_name(const std::string& text);

/// The name of the solve's scene. Throws Failure (usage) if `solve` is not the name of a solve.
std::string scene_name_of(const std::string& solve);

}  // namespace alvor
