#pragma once
// Lights and vectors of messages; encode() is in codec.h.

#include "alvor/v1/scene_service.pb.h"
#include "meshing/light.h"

namespace alvor {

v1::Vector3 encode_vector(Vec3 v);
Vec3 decode_vector(const v1::Vector3& message);

/// Returns the light of a message, without its web and its environment map. Fields that do not count for its kind may be left
/// out: they keep their defaults. Requires: the kind and the shape of the opening are known.
Light decode_light(const v1::Light& message);

}  // namespace alvor
