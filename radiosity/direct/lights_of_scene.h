#pragma once
// Makes the light sources of a scene, in emission units. Nothing else asks of what kind a light is.

#include "radiosity/direct/emission_unit.h"
#include "radiosity/direct/light_source.h"
#include "radiosity/rays/local_scene.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace alvor {

using OwnedLights = std::vector<std::unique_ptr<const LightSource>>;

/// Returns the emission of each material of the mesh.
std::vector<RelativeLight> emission_by_material(const BaseMesh& mesh, const EmissionUnit& unit);

/// Returns a light for each root patch that emits and for each lamp of many such faces (see MeshLight), in the order of the
/// roots. `cover(root)` returns the share of a root's area that is there and emits.
OwnedLights lights_of_faces(
    const LocalScene& scene, const EmissionUnit& unit,
    const std::function<double(std::uint32_t root)>& cover = [](std::uint32_t) { return 1.0; });

/// Returns the lights of the mesh that are not faces and not black, in their order. Their numbers follow those of the roots;
/// in a scene without skies and surroundings, that of a light is the number of roots and its place among the mesh's lights.
OwnedLights lights_beside_faces(const LocalScene& scene, const EmissionUnit& unit);

}  // namespace alvor
