#pragma once
// The RPCs of alvor.v1.SolveService, as a thin layer over SolveStore and Watches.

#include "alvor/v1/solve_service.grpc.pb.h"
#include "server/access/tenants.h"
#include "server/rpc/call_pools.h"
#include "server/solves/solve_store.h"
#include "server/watch/watches.h"

namespace alvor {

/// Implements the RPCs. All its arguments must outlive the server's calls.
class SolveService final : public v1::SolveService::WithRawCallbackMethod_WatchSolve<v1::SolveService::CallbackService> {
 public:
  SolveService(const SceneStore& scenes, SolveStore& solves, Watches& watches, const Tenants& tenants, CallPools& pools,
               spdlog::logger& logger)
      : scenes_(scenes), solves_(solves), watches_(watches), tenants_(tenants), pools_(pools), logger_(logger) {}

 private:
  using Context = grpc::CallbackServerContext;
  using Reactor = grpc::ServerUnaryReactor;

  Reactor* CreateSolve(Context*, const v1::CreateSolveRequest* request, v1::Solve* solve) override;
  Reactor* GetSolve(Context*, const v1::GetSolveRequest* request, v1::Solve* solve) override;
  Reactor* ListSolves(Context*, const v1::ListSolvesRequest* request, v1::ListSolvesResponse* response) override;
  Reactor* CancelSolve(Context*, const v1::CancelSolveRequest* request, v1::Solve* solve) override;
  Reactor* PauseSolve(Context*, const v1::PauseSolveRequest* request, v1::Solve* solve) override;
  Reactor* ResumeSolve(Context*, const v1::ResumeSolveRequest* request, v1::Solve* solve) override;
  Reactor* EditSolve(Context*, const v1::EditSolveRequest* request, v1::EditSolveResponse* response) override;
  Reactor* DeleteSolve(Context*, const v1::DeleteSolveRequest* request, google::protobuf::Empty*) override;
  grpc::ServerWriteReactor<grpc::ByteBuffer>* WatchSolve(Context*, const grpc::ByteBuffer* request) override;
  Reactor* AcknowledgeFrame(Context*, const v1::AcknowledgeFrameRequest* request, v1::AcknowledgeFrameResponse*) override;

  /// Answers from CallPools::keeping, see answer_from.
  template <class Body>
  Reactor* keep(Context* context, const char* call, Body body);

  const SceneStore& scenes_;
  SolveStore& solves_;
  Watches& watches_;
  const Tenants& tenants_;
  CallPools& pools_;
  spdlog::logger& logger_;
  PageTokens tokens_;
};

}  // namespace alvor
