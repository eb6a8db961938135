#pragma once
// Lights and vectors of messages; encode() is in codec.h.

#include "alvor/v1/scene_service.pb.h"
#include "meshing/daylight.h"
#include "meshing/light.h"

#include <optional>

namespace alvor {

v1::Vector3 encode_vector(Vec3 v);
Vec3 decode_vector(const v1::Vector3& message);

/// Returns the light of a message, without its web and its environment map. Fields that do not count for its kind may be left
/// out: they keep their defaults. Requires: the kind and the shape of the opening are known.
Light decode_light(const v1::Light& message);

v1::Daylight encode(const Daylight& daylight);
/// Returns the daylight; nothing where its sky is of a kind that this build does not know.
std::optional<Daylight> decode_daylight(const v1::Daylight& message);

}  // namespace alvor
