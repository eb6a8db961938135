#pragma once
// Calls that receive a scene in many messages.

#include "server/archive/record_codec.h"
#include "server/rpc/answer.h"
#include "server/rpc/call_pools.h"
#include "server/rpc/idle_watch.h"
#include "server/scenes/file_upload.h"
#include "server/scenes/uploads.h"

#include <atomic>
#include <memory>
#include <utility>

namespace alvor {

/// CreateScene, for UploadCall: the scene comes in chunks.
struct ChunkedScene {
  using Message = v1::CreateSceneRequest;
  using Upload = SceneUpload;
  static constexpr const char* call = "CreateScene";
  static WorkPool& pool(CallPools& pools) { return pools.building; }
  /// Returns the upload that the first message of a call begins or resumes.
  static std::unique_ptr<SceneUpload> begin(Uploads& uploads, const UploadLimits& limits, const Caller& caller,
                                            const v1::CreateSceneRequest& first) {
    if (first.resume_after_chunks() > 0) return uploads.take(caller, first.resume_after_chunks());
    auto upload = std::make_unique<SceneUpload>(limits);
    upload->add(first);
    return upload;
  }
};

/// ImportScene, for UploadCall: the scene comes in files.
struct SceneInFiles {
  using Message = v1::ImportSceneRequest;
  using Upload = FileUpload;
  static constexpr const char* call = "ImportScene";
  static WorkPool& pool(CallPools& pools) { return pools.importing; }
  static std::unique_ptr<FileUpload> begin(Uploads& uploads, const UploadLimits& limits, const Caller& caller,
                                           const v1::ImportSceneRequest& first) {
    auto upload = uploads.take_files(caller);
    if (!upload) upload = std::make_unique<FileUpload>(limits);
    upload->begin(first);
    return upload;
  }
};

/// Reads one message at a time into an upload, then stores the scene. Deletes itself.
template <class Kind>
class UploadCall final : public grpc::ServerReadReactor<typename Kind::Message> {
 public:
  UploadCall(grpc::CallbackServerContext& context, Caller caller, SceneStore& scenes, Uploads& uploads,
             const UploadLimits& limits, CallPools& pools, spdlog::logger& logger, v1::Scene& answer)
      : context_(context),
        scenes_(scenes),
        uploads_(uploads),
        limits_(limits),
        pools_(pools),
        logger_(logger),
        answer_(answer),
        caller_(std::move(caller)),
        idle_(std::make_shared<IdleWatch>(pools.timers, limits.patience, [this] {
          finish({grpc::ABORTED, "no message came for too long"});
        })) {
    idle_->wait();
    this->StartRead(&message_);
  }

 private:
  void OnReadDone(bool ok) override {
    if (!ok) return finish_upload();
    idle_->note_message();
    const grpc::Status status = attempt(logger_, Kind::call, [&] { take_message(); });
    if (!status.ok()) return finish(status);
    this->StartRead(&message_);
  }

  /// Finishes the call; only the first of several causes counts.
  void finish(const grpc::Status& status) {
    if (!is_finished_.exchange(true)) this->Finish(status);
  }

  void take_message() {
    if (upload_) return upload_->add(message_);
    uploads_.open(caller_.tenant);
    is_open_ = true;
    check_request_id(message_.request_id());
    caller_.request_id = message_.request_id();
    upload_ = Kind::begin(uploads_, limits_, caller_, message_);
  }

  // Ends the upload after the last read. A read also fails when the client breaks off, and half a scene must not be taken for a
  // whole one; gRPC marks the call cancelled before it reports such a read.
  void finish_upload() {
    idle_->end();  // from here on a timeout cannot end the call
    if (context_.IsCancelled() || is_finished_) {
      keep();
      return finish({grpc::CANCELLED, "the upload was broken off"});
    }
    message_.Clear();
    const grpc::Status status = attempt(logger_, Kind::call, [this] {
      if (!upload_) throw invalid_argument("request: has no messages");
      Kind::pool(pools_).post(turn_of(caller_.tenant, context_), stop_,
                              [this] { finish(attempt(logger_, Kind::call, [this] { store(); })); });
    });
    if (!status.ok()) finish(status);
  }

  /// Lets a later call resume the upload.
  void keep() {
    if (upload_) uploads_.put(caller_, std::move(upload_));
  }

  void OnCancel() override { stop_->stop({grpc::CANCELLED, "the client has gone"}); }

  void store() {
    try {
      const auto stored = upload_->finish(scenes_, caller_, *stop_);
      answer_ = encode(stored->facts);
      logger_.info("scene {} '{}' stored: {} faces, {} bytes received", stored->facts.name, one_line(stored->facts.display_name),
                   stored->facts.face_count, upload_->bytes());
    } catch (const MissingFilesError&) {
      keep();
      throw;
    }
  }

  void OnDone() override {
    idle_->end();
    if (is_open_) uploads_.close(caller_.tenant);
    delete this;
    trim_heap_soon();
  }

  grpc::CallbackServerContext& context_;
  SceneStore& scenes_;
  Uploads& uploads_;
  const UploadLimits& limits_;
  CallPools& pools_;
  spdlog::logger& logger_;
  v1::Scene& answer_;
  Caller caller_;
  std::unique_ptr<typename Kind::Upload> upload_;  ///< null before the first message
  const std::shared_ptr<IdleWatch> idle_;
  const std::shared_ptr<CallStop> stop_ = std::make_shared<CallStop>();  ///< stops the building of the scene
  typename Kind::Message message_;
  bool is_open_ = false;  ///< the upload is counted as open
  std::atomic<bool> is_finished_ = false;
};

}  // namespace alvor
