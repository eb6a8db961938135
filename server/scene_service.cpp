#include "server/scene_service.h"

#include "proto/mesh_codec.h"
#include "server/answer.h"

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>

namespace alvor {

namespace {

/// Tells when nothing came for too long. Whom it tells may be gone before that.
class IdleWatch : public std::enable_shared_from_this<IdleWatch> {
 public:
  using Clock = TaskQueue::Clock;
  IdleWatch(TaskQueue& tasks, Clock::duration patience, std::function<void()> tell)
      : tasks_(tasks), patience_(patience), tell_(std::move(tell)) {}
  void wait() {
    tasks_.post_at(last_.load() + patience_, [self = shared_from_this()] { self->look(); });
  }
  void note_message() { last_ = Clock::now(); }
  /// Nobody is told from now on.
  void end() {
    std::scoped_lock hold(lock_);
    tell_ = nullptr;
  }

 private:
  void look() {
    std::scoped_lock hold(lock_);
    if (!tell_) return;
    if (Clock::now() < last_.load() + patience_) wait();
    else tell_();
  }

  TaskQueue& tasks_;
  const Clock::duration patience_;
  std::mutex lock_;
  std::function<void()> tell_;
  std::atomic<Clock::time_point> last_ = Clock::now();
};

// Reads one message at a time into a SceneUpload. Deletes itself.
class CreateSceneCall final : public grpc::ServerReadReactor<v1::CreateSceneRequest> {
 public:
  CreateSceneCall(grpc::CallbackServerContext& context, Caller caller, SceneStore& scenes, Uploads& uploads,
                  const UploadLimits& limits, TaskQueue& building, spdlog::logger& logger, v1::Scene& answer)
      : context_(context),
        scenes_(scenes),
        uploads_(uploads),
        building_(building),
        logger_(logger),
        answer_(answer),
        caller_(std::move(caller)),
        upload_(std::make_unique<SceneUpload>(limits)),
        idle_(std::make_shared<IdleWatch>(building, limits.patience, [this] {
          finish({grpc::ABORTED, "no message came for too long"});
        })) {
    idle_->wait();
    StartRead(&message_);
  }

 private:
  void OnReadDone(bool ok) override {
    if (!ok) return finish_upload();
    idle_->note_message();
    const grpc::Status status = attempt(logger_, "CreateScene", [&] { take_message(); });
    if (!status.ok()) return finish(status);
    StartRead(&message_);
  }

  /// A call ends once, by whoever is first.
  void finish(const grpc::Status& status) {
    if (!is_finished_.exchange(true)) Finish(status);
  }

  void take_message() {
    if (!is_first_) return upload_->add(message_);
    is_first_ = false;
    uploads_.open(caller_.tenant);
    is_open_ = true;
    check_request_id(message_.request_id());
    caller_.request_id = message_.request_id();
    if (message_.resume_after_chunks() == 0) return upload_->add(message_);
    upload_ = uploads_.take(caller_, message_.resume_after_chunks());
  }

  // A read also fails when the client breaks off, and half a scene must not be taken for a whole one: gRPC marks the call
  // cancelled before it reports such a read.
  void finish_upload() {
    idle_->end();  // whether it has ended the call is settled now
    if (context_.IsCancelled() || is_finished_) {
      if (!is_first_) uploads_.put(caller_, std::move(upload_));
      return finish({grpc::CANCELLED, "the upload was broken off"});
    }
    message_.Clear();
    building_.post([this] {
      const grpc::Status status = attempt(logger_, "CreateScene", [this] { store(); });
      finish(status);
    });
  }

  void store() {
    const auto stored = upload_->finish(scenes_, caller_);
    answer_ = stored->facts;
    logger_.info("scene {} '{}' stored: {} faces, {} bytes received", answer_.name(), one_line(answer_.display_name()),
                 answer_.face_count(), upload_->bytes());
  }

  void OnDone() override {
    idle_->end();
    if (is_open_) uploads_.close(caller_.tenant);
    delete this;
  }

  grpc::CallbackServerContext& context_;
  SceneStore& scenes_;
  Uploads& uploads_;
  TaskQueue& building_;
  spdlog::logger& logger_;
  v1::Scene& answer_;
  Caller caller_;
  std::unique_ptr<SceneUpload> upload_;
  const std::shared_ptr<IdleWatch> idle_;
  v1::CreateSceneRequest message_;
  bool is_first_ = true;
  bool is_open_ = false;  ///< counted among the open ones
  std::atomic<bool> is_finished_ = false;
};

bool next(SceneSlicer& slicer, v1::ReadSceneResponse& message) { return slicer.next(*message.mutable_chunk()); }
bool next(MeshSlicer& slicer, v1::ReadMeshResponse& message) { return slicer.next(message); }

// Sends a part of a scene's content piece by piece. Deletes itself.
template <class Message, class Slicer>
class SendCall final : public grpc::ServerWriteReactor<Message> {
 public:
  template <class Part>
  SendCall(std::shared_ptr<const SceneContent> content, const Part& part) : content_(std::move(content)), slicer_(part) {
    send_next();
  }

 private:
  void send_next() {
    if (next(slicer_, message_)) this->StartWrite(&message_);
    else this->Finish(grpc::Status::OK);
  }
  void OnWriteDone(bool ok) override {
    if (ok) send_next();
    else this->Finish({grpc::CANCELLED, "the reader has gone"});
  }
  void OnDone() override { delete this; }

  const std::shared_ptr<const SceneContent> content_;
  Slicer slicer_;
  Message message_;
};

// A stream that ends as soon as it begins. Deletes itself.
template <class Reactor>
class Refusal final : public Reactor {
 public:
  explicit Refusal(const grpc::Status& status) { this->Finish(status); }

 private:
  void OnDone() override { delete this; }
};

}  // namespace

grpc::ServerReadReactor<v1::CreateSceneRequest>* SceneService::CreateScene(Context* context, v1::Scene* scene) {
  Caller caller;
  const grpc::Status status = attempt(logger_, "CreateScene", [&] { caller.tenant = tenants_.of(*context); });
  if (!status.ok()) return new Refusal<grpc::ServerReadReactor<v1::CreateSceneRequest>>(status);
  return new CreateSceneCall(*context, std::move(caller), scenes_, uploads_, limits_, building_, logger_, *scene);
}

SceneService::Reactor* SceneService::GetUpload(Context* context, const v1::GetUploadRequest* request, v1::Upload* upload) {
  return answer(context, logger_, "GetUpload", [&] {
    upload->set_chunk_count(uploads_.chunks({tenants_.of(*context), request->request_id()}));
  });
}

SceneService::Reactor* SceneService::GetScene(Context* context, const v1::GetSceneRequest* request, v1::Scene* scene) {
  return answer(context, logger_, "GetScene", [&] { *scene = scenes_.find(request->name(), tenants_.of(*context))->facts; });
}

SceneService::Reactor* SceneService::ListScenes(Context* context, const v1::ListScenesRequest* request,
                                                v1::ListScenesResponse* response) {
  return answer(context, logger_, "ListScenes", [&] {
    const auto page = scenes_.list(tokens_.request(request->page_size(), request->page_token()), tenants_.of(*context));
    for (const auto& stored : page.items) *response->add_scenes() = stored->facts;
    response->set_next_page_token(tokens_.token(page.next_before));
  });
}

SceneService::Reactor* SceneService::DeleteScene(Context* context, const v1::DeleteSceneRequest* request,
                                                 google::protobuf::Empty*) {
  return answer(context, logger_, "DeleteScene", [&] { scenes_.remove(request->name(), tenants_.of(*context)); });
}

template <class Message, class Slicer, class Part>
grpc::ServerWriteReactor<Message>* SceneService::send(Context& context, const char* call, const std::string& scene, Part part) {
  std::shared_ptr<const SceneContent> content;
  const grpc::Status status = attempt(logger_, call, [&] { content = scenes_.find(scene, tenants_.of(context))->content(); });
  if (!status.ok()) return new Refusal<grpc::ServerWriteReactor<Message>>(status);
  const auto& sent = (*content).*part;
  return new SendCall<Message, Slicer>(std::move(content), sent);
}

grpc::ServerWriteReactor<v1::ReadSceneResponse>* SceneService::ReadScene(Context* context, const v1::ReadSceneRequest* request) {
  return send<v1::ReadSceneResponse, SceneSlicer>(*context, "ReadScene", request->name(), &SceneContent::scene);
}

grpc::ServerWriteReactor<v1::ReadMeshResponse>* SceneService::ReadMesh(Context* context, const v1::ReadMeshRequest* request) {
  return send<v1::ReadMeshResponse, MeshSlicer>(*context, "ReadMesh", request->name(), &SceneContent::mesh);
}

}  // namespace alvor
