#pragma once
// The RPCs of alvor.v1.SceneService, as a thin layer over SceneStore.

#include "alvor/v1/scene_service.grpc.pb.h"
#include "server/access/tenants.h"
#include "server/rpc/call_pools.h"
#include "server/scenes/scene_upload.h"
#include "server/scenes/uploads.h"
#include "server/solves/solve_store.h"

#include <optional>

namespace spdlog {
class logger;
}

namespace alvor {

/// Implements the RPCs. All its arguments must outlive the server's calls.
class SceneService final : public v1::SceneService::CallbackService {
 public:
  SceneService(SceneStore& scenes, const SolveStore& solves, const Tenants& tenants, const UploadLimits& limits, CallPools& pools,
               spdlog::logger& logger);

 private:
  using Context = grpc::CallbackServerContext;
  using Reactor = grpc::ServerUnaryReactor;

  grpc::ServerReadReactor<v1::CreateSceneRequest>* CreateScene(Context*, v1::Scene* scene) override;
  grpc::ServerReadReactor<v1::ImportSceneRequest>* ImportScene(Context*, v1::Scene* scene) override;
  Reactor* GetUpload(Context*, const v1::GetUploadRequest* request, v1::Upload* upload) override;
  Reactor* GetScene(Context*, const v1::GetSceneRequest* request, v1::Scene* scene) override;
  Reactor* ListScenes(Context*, const v1::ListScenesRequest* request, v1::ListScenesResponse* response) override;
  Reactor* DeleteScene(Context*, const v1::DeleteSceneRequest* request, google::protobuf::Empty*) override;
  grpc::ServerWriteReactor<v1::ReadSceneResponse>* ReadScene(Context*, const v1::ReadSceneRequest* request) override;
  grpc::ServerWriteReactor<v1::ReadMeshResponse>* ReadMesh(Context*, const v1::ReadMeshRequest* request) override;
  grpc::ServerWriteReactor<v1::ReadImagesResponse>* ReadImages(Context*, const v1::ReadImagesRequest* request) override;

  /// Receives a scene, see UploadCall.
  template <class Kind>
  grpc::ServerReadReactor<typename Kind::Message>* receive(Context* context, v1::Scene* scene);
  /// Answers from CallPools::keeping, see answer_from.
  template <class Body>
  Reactor* keep(Context* context, const char* call, Body body);
  /// Streams the part of the content of a scene, or of a solve with its edits up to a revision or all of them, that `part`
  /// returns, cut into messages by a Slicer.
  template <class Message, class Slicer, class Part>
  grpc::ServerWriteReactor<Message>* send(Context& context, const char* call, const std::string& name,
                                          std::optional<std::uint64_t> edits, Part part);

  SceneStore& scenes_;
  const SolveStore& solves_;
  const Tenants& tenants_;
  const UploadLimits limits_;
  Uploads uploads_;
  CallPools& pools_;
  spdlog::logger& logger_;
  PageTokens tokens_;
  std::shared_ptr<void> relief_;  ///< drops waiting uploads; uses `uploads_`
};

}  // namespace alvor
