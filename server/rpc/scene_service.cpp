#include "server/rpc/scene_service.h"

#include "proto/mesh_codec.h"
#include "server/rpc/answer.h"
#include "server/rpc/idle_watch.h"
#include "server/rpc/upload_call.h"

#include <memory>
#include <optional>

namespace alvor {

SceneService::SceneService(SceneStore& scenes, const SolveStore& solves, const Tenants& tenants, const UploadLimits& limits,
                           CallPools& pools, spdlog::logger& logger)
    : scenes_(scenes), solves_(solves), tenants_(tenants), limits_(limits), pools_(pools), logger_(logger) {
  relief_ = limits_.memory.relieve_by([this] { uploads_.clear(); });
}

namespace {

bool next(SceneSlicer& slicer, v1::ReadSceneResponse& message) { return slicer.next(*message.mutable_chunk()); }
/// Cuts a mesh with its lights and objects.
class WholeMeshSlicer : public MeshSlicer {
 public:
  explicit WholeMeshSlicer(const BaseMesh& mesh) : MeshSlicer(mesh, 10'000, MeshParts::all) {}
};
bool next(MeshSlicer& slicer, v1::ReadMeshResponse& message) { return slicer.next(message); }

/// Cuts the images of a scene's textures.
class SceneImageSlicer : public MeshImageSlicer {
 public:
  explicit SceneImageSlicer(const Scene& scene) : MeshImageSlicer(scene.materials) {}
};
bool next(SceneImageSlicer& slicer, v1::ReadImagesResponse& message) { return slicer.next(message); }

/// Returns the revision up to which edits were asked for, if one was.
std::optional<std::uint64_t> edits_of(const auto& request) {
  return request.has_edits() ? std::optional<std::uint64_t>(request.edits()) : std::nullopt;
}

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

template <class Kind>
grpc::ServerReadReactor<typename Kind::Message>* SceneService::receive(Context* context, v1::Scene* scene) {
  Caller caller;
  const grpc::Status status = attempt(logger_, Kind::call, [&] { caller.tenant = tenants_.of(*context); });
  if (!status.ok()) return new Refusal<grpc::ServerReadReactor<typename Kind::Message>>(status);
  return new UploadCall<Kind>(*context, std::move(caller), scenes_, uploads_, limits_, pools_, logger_, *scene);
}

grpc::ServerReadReactor<v1::CreateSceneRequest>* SceneService::CreateScene(Context* context, v1::Scene* scene) {
  return receive<ChunkedScene>(context, scene);
}

grpc::ServerReadReactor<v1::ImportSceneRequest>* SceneService::ImportScene(Context* context, v1::Scene* scene) {
  return receive<SceneInFiles>(context, scene);
}

template <class Body>
SceneService::Reactor* SceneService::keep(Context* context, const char* call, Body body) {
  return answer_from(pools_.keeping, tenants_, context, logger_, call, body);
}

SceneService::Reactor* SceneService::GetUpload(Context* context, const v1::GetUploadRequest* request, v1::Upload* upload) {
  return keep(context, "GetUpload", [this, request, upload](const std::string& tenant) {
    *upload = uploads_.describe({tenant, request->request_id()});
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
grpc::ServerWriteReactor<Message>* SceneService::send(Context& context, const char* call, const std::string& name,
                                                      std::optional<std::uint64_t> edits, Part part) {
  std::string tenant;
  const grpc::Status refusal = attempt(logger_, call, [&] { tenant = tenants_.of(context); });
  if (!refusal.ok()) return new Refusal<grpc::ServerWriteReactor<Message>>(refusal);
  const auto load = [this, name, tenant, edits](const CallStop& stop) {
    const auto end_of_scene = name.find("/solves/");
    const auto solve = end_of_scene == std::string::npos ? nullptr : solves_.find(name, tenant);
    const auto stored = scenes_.find(name.substr(0, end_of_scene), tenant);
    if (edits && !solve) throw invalid_argument("edits: only solves have them");
    limits_.memory.admit("scene", 2 * stored->facts.content_bytes);
    return solve ? solve->content(stop, edits) : stored->content(stop);
  };
  return new SendCall<Message, Slicer, Part>(context, pools_, limits_.patience, turn_of(tenant, context), logger_, call, part,
                                             load);
}

grpc::ServerWriteReactor<v1::ReadSceneResponse>* SceneService::ReadScene(Context* context, const v1::ReadSceneRequest* request) {
  return send<v1::ReadSceneResponse, SceneSlicer>(*context, "ReadScene", request->name(), edits_of(*request),
                                                  &SceneContent::scene);
}

grpc::ServerWriteReactor<v1::ReadMeshResponse>* SceneService::ReadMesh(Context* context, const v1::ReadMeshRequest* request) {
  return send<v1::ReadMeshResponse, WholeMeshSlicer>(*context, "ReadMesh", request->name(), edits_of(*request),
                                                     &SceneContent::mesh);
}

grpc::ServerWriteReactor<v1::ReadImagesResponse>* SceneService::ReadImages(Context* context,
                                                                           const v1::ReadImagesRequest* request) {
  return send<v1::ReadImagesResponse, SceneImageSlicer>(*context, "ReadImages", request->name(), {}, &SceneContent::scene);
}

}  // namespace alvor
