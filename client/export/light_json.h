#pragma once
// How solution files hold the lights of their scene.

#include "meshing/scene.h"

#include <nlohmann/json_fwd.hpp>

#include <cstddef>
#include <span>

namespace alvor {

/// Returns an object with the fields of alvor.v1.Light; lengths in metres, angles in radians. A luminaire has its photometric web
/// unless an earlier one has the same: then `web_of` tells by its number from 0 which of `lights`. Environments
/// share their maps by `environment_of`. A map is reduced to at most 128 x 64 pixels with four digits, so that a file grows by
/// less than 300 KB.
nlohmann::json json_of(std::span<const Light> lights, std::size_t which);
/// Reads what json_of() wrote, after the lights before it. Throws SolutionFileError that names the light.
Light light_of(const nlohmann::json& json, std::span<const Light> before);

}  // namespace alvor
