#pragma once
// Lights of messages; encode() is in codec.h.

#include "alvor/v1/scene_service.pb.h"
#include "meshing/light.h"

namespace alvor {

/// Returns the light of a message, without its web and its environment map. Fields that do not count for its kind may be left
/// out: they keep their defaults. Requires: the kind and the shape of the opening are known.
Light decode_light(const v1::Light& message);

}  // namespace alvor
