#pragma once
// How the geometry and materials of a scene are written down: as chunks of the API, one after the other.

#include "meshing/scene.h"
#include "proto/codec.h"
#include "server/base/sha256.h"
#include "server/base/status_error.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>

namespace alvor {

/// The SHA-256 of a scene's content, under which it is stored, and its size.
struct SceneBytes {
  std::string sha256;  ///< hexadecimal digits
  std::uint64_t bytes = 0;
};
SceneBytes measure(const Scene& scene);

/// Calls `body` with the bytes of each chunk of the scene.
void for_each_chunk(const Scene& scene, const std::function<void(std::span<const std::byte>)>& body);

/// Returns DATA_LOSS for the content of a scene.
StatusError damaged_content(const std::string& why);

/// Reads what for_each_chunk() wrote, and checks all of it. Throws StatusError DATA_LOSS.
class ContentReader {
 public:
  void add(std::span<const std::byte> chunk);
  /// Returns the scene. Requires: all chunks were added.
  Scene take(const std::string& sha256);

 private:
  SceneAssembler assembler_;
  Sha256 sum_;
};

}  // namespace alvor
