#pragma once
// A scene on its way in.

#include "proto/codec.h"
#include "server/base/memory_guard.h"
#include "server/scenes/scene_store.h"

#include <chrono>

namespace alvor {

/// Beyond these an upload is refused with RESOURCE_EXHAUSTED.
struct UploadLimits {
  std::uint64_t bytes = std::uint64_t{2} << 30;                            ///< of messages
  std::uint64_t corners = 50'000'000;                                      ///< of all faces
  std::chrono::steady_clock::duration patience = std::chrono::minutes(1);  ///< between messages; then ABORTED
  std::uint64_t corners_of_face = 20'000;  ///< cutting up one that crosses itself takes half a second
  std::uint64_t bytes_of_name = 1000;      ///< of a material
  std::uint64_t materials = 1'000'000;     ///< an empty one is two bytes on the wire, but not in memory
  MemoryGuard memory;
};

/// One CreateScene call without the network. Not thread-safe. Throws StatusError; the upload is then over.
class SceneUpload {
 public:
  explicit SceneUpload(const UploadLimits& limits) : limits_(limits) {}
  void add(const v1::CreateSceneRequest& message);
  /// All messages have arrived: checks and stores the scene, unless `stop` ends it.
  std::shared_ptr<const StoredScene> finish(SceneStore& store, const Caller& caller = {}, const CallStop& stop = {});
  std::uint64_t chunks() const { return chunks_; }
  std::uint64_t bytes() const { return bytes_; }

 private:
  void check_limits(const v1::GeometryChunk& chunk) const;

  UploadLimits limits_;
  SceneAssembler assembler_;
  std::string display_name_;
  std::uint64_t bytes_ = 0, chunks_ = 0;
  bool begun_ = false;
};

}  // namespace alvor
