#pragma once
// How solution files hold the lights of their scene.

#include "meshing/scene.h"

#include <nlohmann/json_fwd.hpp>

namespace alvor {

/// Returns an object with the fields of alvor.v1.Light; lengths in metres, angles in radians.
nlohmann::json json_of(const Light& light);
/// Reads what json_of() wrote. Throws SolutionFileError that names `place`.
Light light_of(const nlohmann::json& json, const std::string& place);

}  // namespace alvor
