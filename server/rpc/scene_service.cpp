#include "server/rpc/scene_service.h"

#include "proto/mesh_codec.h"
#include "server/archive/record_codec.h"
#include "server/rpc/answer.h"

#include <atomic>
#include <functional>
#include <memory>
#include <optional>

namespace alvor {

namespace {

/// Calls `tell` when no message came for as long as `patience`. end() must be called before the receiver of `tell` is destroyed.
class IdleWatch : public std::enable_shared_from_this<IdleWatch> {
 public:
  using Clock = TaskQueue::Clock;
  IdleWatch(TaskQueue& tasks, Clock::duration patience, std::function<void()> tell)
      : tasks_(tasks), patience_(patience), tell_(std::move(tell)) {}
  void wait() {
    tasks_.post_at(last_.load() + patience_, [self = shared_from_this()] { self->look(); });
  }
  void note_message() { last_ = Clock::now(); }
  /// Stops: `tell` is not called from now on.
  void end() {
    Lock hold(lock_);
    tell_ = nullptr;
  }

 private:
  void look() {
    Lock hold(lock_);
    if (!tell_) return;
    if (Clock::now() < last_.load() + patience_) wait();
    else tell_();
  }

  TaskQueue& tasks_;
  const Clock::duration patience_;
  Mutex lock_;
  std::function<void()> tell_ ALVOR_GUARDED_BY(lock_);
  std::atomic<Clock::time_point> last_ = Clock::now();
};

// The CreateScene call: reads one message at a time into a SceneUpload. Deletes itself.
class CreateSceneCall final : public grpc::ServerReadReactor<v1::CreateSceneRequest> {
 public:
  CreateSceneCall(grpc::CallbackServerContext& context, Caller caller, SceneStore& scenes, Uploads& uploads,
                  const UploadLimits& limits, CallPools& pools, spdlog::logger& logger, v1::Scene& answer)
      : context_(context),
        scenes_(scenes),
        uploads_(uploads),
        pools_(pools),
        logger_(logger),
        answer_(answer),
        caller_(std::move(caller)),
        upload_(std::make_unique<SceneUpload>(limits)),
        idle_(std::make_shared<IdleWatch>(pools.timers, limits.patience, [this] {
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

  /// Finishes the call; only the first of several causes counts.
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

  // Ends the upload after the last read. A read also fails when the client breaks off, and half a scene must not be taken for a
  // whole one; gRPC marks the call cancelled before it reports such a read.
  void finish_upload() {
    idle_->end();  // from here on a timeout cannot end the call
    if (context_.IsCancelled() || is_finished_) {
      if (!is_first_) uploads_.put(caller_, std::move(upload_));
      return finish({grpc::CANCELLED, "the upload was broken off"});
    }
    message_.Clear();
    const grpc::Status status = attempt(logger_, "CreateScene", [this] {
      pools_.building.post(turn_of(caller_.tenant, context_), stop_,
                           [this] { finish(attempt(logger_, "CreateScene", [this] { store(); })); });
    });
    if (!status.ok()) finish(status);
  }

  void OnCancel() override { stop_->stop({grpc::CANCELLED, "the client has gone"}); }

  void store() {
    const auto stored = upload_->finish(scenes_, caller_, *stop_);
    answer_ = encode(stored->facts);
    logger_.info("scene {} '{}' stored: {} faces, {} bytes received", stored->facts.name, one_line(stored->facts.display_name),
                 stored->facts.face_count, upload_->bytes());
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
  CallPools& pools_;
  spdlog::logger& logger_;
  v1::Scene& answer_;
  Caller caller_;
  std::unique_ptr<SceneUpload> upload_;
  const std::shared_ptr<IdleWatch> idle_;
  const std::shared_ptr<CallStop> stop_ = std::make_shared<CallStop>();  ///< stops the building of the scene
  v1::CreateSceneRequest message_;
  bool is_first_ = true;
  bool is_open_ = false;  ///< the upload is counted as open
  std::atomic<bool> is_finished_ = false;
};

bool next(SceneSlicer& slicer, v1::ReadSceneResponse& message) { return slicer.next(*message.mutable_chunk()); }
bool next(MeshSlicer& slicer, v1::ReadMeshResponse& message) { return slicer.next(message); }

// A call that loads a scene and sends a part of its content, piece by piece. Deletes itself.
template <class Message, class Slicer, class Part>
class SendCall final : public grpc::ServerWriteReactor<Message> {
 public:
  /// `load` returns the content and runs on a thread of the pool for building. A reader that takes nothing for as long as
  /// `patience` is cancelled, because the content takes memory.
  template <class Load>
  SendCall(grpc::CallbackServerContext& context, CallPools& pools, std::chrono::steady_clock::duration patience,
           const std::string& turn, spdlog::logger& logger, const char* call, Part part, Load load)
      : idle_(std::make_shared<IdleWatch>(pools.timers, patience, [&context] { context.TryCancel(); })) {
    const grpc::Status refusal = attempt(logger, call, [&] {
      pools.building.post(turn, stop_, [this, &logger, call, part, load] {
        const grpc::Status status = attempt(logger, call, [&] { content_ = load(*stop_); });
        if (!status.ok()) return this->Finish(status);
        slicer_.emplace((*content_).*part);
        idle_->note_message();
        idle_->wait();
        send_next();
      });
    });
    if (!refusal.ok()) this->Finish(refusal);
  }

 private:
  void send_next() {
    if (next(*slicer_, message_)) this->StartWrite(&message_);
    else this->Finish(grpc::Status::OK);
  }
  void OnWriteDone(bool ok) override {
    idle_->note_message();
    if (ok) send_next();
    else this->Finish({grpc::CANCELLED, "the reader has gone"});
  }
  void OnCancel() override { stop_->stop({grpc::CANCELLED, "the reader has gone"}); }
  void OnDone() override {
    idle_->end();
    const bool held_content = content_ != nullptr;
    delete this;
    if (held_content) trim_heap_soon();
  }

  const std::shared_ptr<IdleWatch> idle_;
  const std::shared_ptr<CallStop> stop_ = std::make_shared<CallStop>();
  std::shared_ptr<const SceneContent> content_;
  std::optional<Slicer> slicer_;
  Message message_;
};

}  // namespace

grpc::ServerReadReactor<v1::CreateSceneRequest>* SceneService::CreateScene(Context* context, v1::Scene* scene) {
  Caller caller;
  const grpc::Status status = attempt(logger_, "CreateScene", [&] { caller.tenant = tenants_.of(*context); });
  if (!status.ok()) return new Refusal<grpc::ServerReadReactor<v1::CreateSceneRequest>>(status);
  return new CreateSceneCall(*context, std::move(caller), scenes_, uploads_, limits_, pools_, logger_, *scene);
}

template <class Body>
SceneService::Reactor* SceneService::keep(Context* context, const char* call, Body body) {
  return answer_from(pools_.keeping, tenants_, context, logger_, call, body);
}

SceneService::Reactor* SceneService::GetUpload(Context* context, const v1::GetUploadRequest* request, v1::Upload* upload) {
  return keep(context, "GetUpload", [this, request, upload](const std::string& tenant) {
    upload->set_chunk_count(uploads_.chunks({tenant, request->request_id()}));
  });
}

SceneService::Reactor* SceneService::GetScene(Context* context, const v1::GetSceneRequest* request, v1::Scene* scene) {
  return keep(context, "GetScene", [this, request, scene](const std::string& tenant) {
    *scene = encode(scenes_.find(request->name(), tenant)->facts);
  });
}

SceneService::Reactor* SceneService::ListScenes(Context* context, const v1::ListScenesRequest* request,
                                                v1::ListScenesResponse* response) {
  return keep(context, "ListScenes", [this, request, response](const std::string& tenant) {
    const auto page = scenes_.list(tokens_.request(request->page_size(), request->page_token()), tenant);
    for (const auto& stored : page.items) *response->add_scenes() = encode(stored->facts);
    response->set_next_page_token(tokens_.token(page.next_before));
  });
}

SceneService::Reactor* SceneService::DeleteScene(Context* context, const v1::DeleteSceneRequest* request,
                                                 google::protobuf::Empty*) {
  return keep(context, "DeleteScene", [this, request](const std::string& tenant) { scenes_.remove(request->name(), tenant); });
}

template <class Message, class Slicer, class Part>
grpc::ServerWriteReactor<Message>* SceneService::send(Context& context, const char* call, const std::string& scene, Part part) {
  std::string tenant;
  const grpc::Status refusal = attempt(logger_, call, [&] { tenant = tenants_.of(context); });
  if (!refusal.ok()) return new Refusal<grpc::ServerWriteReactor<Message>>(refusal);
  const auto load = [this, scene, tenant](const CallStop& stop) {
    const auto stored = scenes_.find(scene, tenant);
    limits_.memory.admit("scene", 2 * stored->facts.content_bytes);
    return stored->content(stop);
  };
  return new SendCall<Message, Slicer, Part>(context, pools_, limits_.patience, turn_of(tenant, context), logger_, call, part,
                                             load);
}

grpc::ServerWriteReactor<v1::ReadSceneResponse>* SceneService::ReadScene(Context* context, const v1::ReadSceneRequest* request) {
  return send<v1::ReadSceneResponse, SceneSlicer>(*context, "ReadScene", request->name(), &SceneContent::scene);
}

grpc::ServerWriteReactor<v1::ReadMeshResponse>* SceneService::ReadMesh(Context* context, const v1::ReadMeshRequest* request) {
  return send<v1::ReadMeshResponse, MeshSlicer>(*context, "ReadMesh", request->name(), &SceneContent::mesh);
}

}  // namespace alvor
