#pragma once
// Receives a scene in pieces.

#include "import/apart/run_importer.h"
#include "proto/codec.h"
#include "server/base/memory_guard.h"
#include "server/scenes/resumable_upload.h"
#include "server/scenes/scene_store.h"

#include <chrono>
#include <string>
#include <vector>

namespace alvor {

/// Limits of an upload. An upload beyond one of them is refused with RESOURCE_EXHAUSTED.
struct UploadLimits {
  std::uint64_t bytes = std::uint64_t{2} << 30;                            ///< sum over the messages
  std::uint64_t corners = 50'000'000;                                      ///< sum over the faces
  std::chrono::steady_clock::duration patience = std::chrono::minutes(1);  ///< longest time between messages; then ABORTED
  std::uint64_t corners_of_face = 20'000;  ///< cutting up a face that crosses itself takes half a second at this size
  std::uint64_t bytes_of_name = 1000;      ///< length of the name of a material, light or object
  std::uint64_t materials = 1'000'000;     ///< an empty material takes two bytes on the wire but more in memory
  std::uint64_t lights = 100'000;          ///< those that are not faces
  std::uint64_t objects = 1'000'000;
  MemoryGuard memory;
  ImporterOptions importer;
};

/// Throws a StatusError RESOURCE_EXHAUSTED if an upload has more of something than the limit.
void refuse_beyond(std::uint64_t count, std::uint64_t limit, const char* unit);

/// The logic of one CreateScene call, without the network. Not thread-safe. A StatusError that it throws ends the upload.
class SceneUpload : public ResumableUpload {
 public:
  explicit SceneUpload(const UploadLimits& limits) : limits_(limits) {}
  void add(const v1::CreateSceneRequest& message);
  /// Checks and stores the scene after all messages have arrived, unless `stop` ends it.
  /// `warnings` are told with the scene.
  std::shared_ptr<const StoredScene> finish(SceneStore& store, const Caller& caller = {}, const CallStop& stop = {},
                                            std::vector<std::string> warnings = {});
  std::uint64_t chunks() const { return chunks_; }
  std::uint64_t bytes() const override { return bytes_; }
  void describe(v1::Upload& upload) const override { upload.set_chunk_count(chunks_); }

 private:
  void check_limits(const v1::GeometryChunk& chunk) const;

  UploadLimits limits_;
  SceneAssembler assembler_;
  std::string display_name_;
  std::uint64_t bytes_ = 0, chunks_ = 0;
  bool begun_ = false;
};

}  // namespace alvor
