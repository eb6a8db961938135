#include "server/scene_service.h"

#include "server/answer.h"

namespace alvor {

namespace {

// Reads one message at a time into a SceneUpload. Deletes itself.
class CreateSceneCall final : public grpc::ServerReadReactor<v1::CreateSceneRequest> {
 public:
  CreateSceneCall(grpc::CallbackServerContext& context, SceneStore& scenes, const UploadLimits& limits, TaskQueue& building,
                  spdlog::logger& logger, v1::Scene& answer)
      : context_(context), scenes_(scenes), building_(building), logger_(logger), answer_(answer), upload_(limits) {
    StartRead(&message_);
  }

 private:
  void OnReadDone(bool ok) override {
    if (!ok) return finish_upload();
    const grpc::Status status = attempt(logger_, "CreateScene", [&] { upload_.add(message_); });
    if (!status.ok()) return Finish(status);
    StartRead(&message_);
  }

  // A read also fails when the client breaks off, and half a scene must not be taken for a whole one: gRPC marks the call
  // cancelled before it reports such a read.
  void finish_upload() {
    if (context_.IsCancelled()) return Finish({grpc::CANCELLED, "the upload was broken off"});
    message_.Clear();
    building_.post([this] {
      const grpc::Status status = attempt(logger_, "CreateScene", [this] { store(); });
      Finish(status);
    });
  }

  void store() {
    const auto stored = upload_.finish(scenes_);
    answer_ = stored->facts;
    logger_.info("scene {} '{}' stored: {} faces, {} bytes received", answer_.name(), one_line(answer_.display_name()),
                 answer_.face_count(), upload_.bytes());
  }

  void OnDone() override { delete this; }

  grpc::CallbackServerContext& context_;
  SceneStore& scenes_;
  TaskQueue& building_;
  spdlog::logger& logger_;
  v1::Scene& answer_;
  SceneUpload upload_;
  v1::CreateSceneRequest message_;
};

// Sends a scene chunk by chunk. Deletes itself.
class ReadSceneCall final : public grpc::ServerWriteReactor<v1::ReadSceneResponse> {
 public:
  explicit ReadSceneCall(std::shared_ptr<const StoredScene> stored) : stored_(std::move(stored)), slicer_(stored_->scene) {
    send_next();
  }

 private:
  void send_next() {
    if (slicer_.next(*message_.mutable_chunk())) StartWrite(&message_);
    else Finish(grpc::Status::OK);
  }
  void OnWriteDone(bool ok) override {
    if (ok) send_next();
    else Finish({grpc::CANCELLED, "the reader has gone"});
  }
  void OnDone() override { delete this; }

  const std::shared_ptr<const StoredScene> stored_;
  SceneSlicer slicer_;
  v1::ReadSceneResponse message_;
};

// A stream that ends as soon as it begins. Deletes itself.
class RefusedRead final : public grpc::ServerWriteReactor<v1::ReadSceneResponse> {
 public:
  explicit RefusedRead(const grpc::Status& status) { Finish(status); }

 private:
  void OnDone() override { delete this; }
};

}  // namespace

grpc::ServerReadReactor<v1::CreateSceneRequest>* SceneService::CreateScene(Context* context, v1::Scene* scene) {
  return new CreateSceneCall(*context, scenes_, limits_, building_, logger_, *scene);
}

SceneService::Reactor* SceneService::GetScene(Context* context, const v1::GetSceneRequest* request, v1::Scene* scene) {
  return answer(context, logger_, "GetScene", [&] { *scene = scenes_.find(request->name())->facts; });
}

SceneService::Reactor* SceneService::ListScenes(Context* context, const v1::ListScenesRequest* request,
                                                v1::ListScenesResponse* response) {
  return answer(context, logger_, "ListScenes", [&] {
    const auto page = scenes_.list(tokens_.request(request->page_size(), request->page_token()));
    for (const auto& stored : page.items) *response->add_scenes() = stored->facts;
    response->set_next_page_token(tokens_.token(page.next_before));
  });
}

SceneService::Reactor* SceneService::DeleteScene(Context* context, const v1::DeleteSceneRequest* request,
                                                 google::protobuf::Empty*) {
  return answer(context, logger_, "DeleteScene", [&] { scenes_.remove(request->name()); });
}

grpc::ServerWriteReactor<v1::ReadSceneResponse>* SceneService::ReadScene(Context*, const v1::ReadSceneRequest* request) {
  std::shared_ptr<const StoredScene> stored;
  const grpc::Status status = attempt(logger_, "ReadScene", [&] { stored = scenes_.find(request->name()); });
  if (!status.ok()) return new RefusedRead(status);
  return new ReadSceneCall(std::move(stored));
}

}  // namespace alvor
