#pragma once
// Sun, sky and ground that are added to a scene.

#include "alvor/v1/scene_service.pb.h"
#include "meshing/scene.h"

#include <string>
#include <vector>

namespace alvor {

/// Appends sun, sky and ground to the scene's lights. `lumens_per_watt` converts what the models say for scenes of the other
/// quantity. Throws ImportError for values that are out of range or do not fit together.
void add_daylight(const v1::Daylight& wanted, double lumens_per_watt, Scene& scene, std::vector<std::string>& warnings);

}  // namespace alvor
