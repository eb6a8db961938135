#pragma once
// The record of a scene: its name, counts and warnings, without its geometry and materials.

#include "meshing/scene.h"

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace alvor {

/// The metadata of a stored scene.
struct SceneRecord {
  std::string name;          ///< `scenes/{scene}`
  std::string display_name;  ///< for people
  std::chrono::system_clock::time_point create_time;
  std::uint64_t vertex_count = 0, face_count = 0, material_count = 0, object_count = 0;
  std::uint64_t light_count = 0;      ///< of lights that are not faces
  std::optional<Quantity> quantity;   ///< not known of scenes that version 0.1.0 stored
  std::optional<UpAxis> up;           ///< likewise
  double north_degrees = 0;           ///< see Scene
  std::vector<std::string> warnings;  ///< a sentence for each change or oddity
  std::string content_sha256;         ///< hexadecimal digits; scenes of equal content are stored once
  std::uint64_t content_bytes = 0;    ///< before compression
};

}  // namespace alvor
