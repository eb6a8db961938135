#pragma once
// Receives the files of a scene and has them read.

#include "import/base/scene_files.h"
#include "server/base/error_details.h"
#include "server/scenes/resumable_upload.h"
#include "server/scenes/scene_upload.h"

#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace alvor {

/// The logic of ImportScene calls with one request id, without the network. Not thread-safe. A StatusError that it throws ends
/// the upload, except for MissingFilesError.
class FileUpload : public ResumableUpload {
 public:
  explicit FileUpload(const UploadLimits& limits) : limits_(limits) {}

  /// Begins a call with its first message. Files of earlier calls stay.
  void begin(const v1::ImportSceneRequest& message);
  void add(const v1::ImportSceneRequest& message);
  /// Has the scene read, and stores it, after all messages of a call have arrived, unless `stop` ends it. Throws
  /// MissingFilesError, and later calls may then add those files; INVALID_ARGUMENT names the scene file.
  std::shared_ptr<const StoredScene> finish(SceneStore& store, const Caller& caller = {}, const CallStop& stop = {});

  std::uint64_t bytes() const override { return bytes_; }
  void describe(v1::Upload& upload) const override;

 private:
  void add_piece(const v1::FilePiece& piece);
  /// Reads into `scene` and returns the warnings. Throws as finish() does.
  std::vector<std::string> read(SceneFiles& files, SceneUpload& scene, const CallStop& stop) const;

  UploadLimits limits_;
  v1::ImportOptions options_;
  std::map<std::string, std::string> files_;
  std::uint64_t bytes_ = 0;
};

}  // namespace alvor
