#include "server/solve_service.h"

#include "server/answer.h"
#include "server/watch_call.h"

namespace alvor {

namespace {

v1::WatchSolveRequest parse(grpc::ByteBuffer bytes) {
  v1::WatchSolveRequest request;
  if (!grpc::SerializationTraits<v1::WatchSolveRequest>::Deserialize(&bytes, &request).ok())
    throw invalid_argument("the message is not a WatchSolveRequest");
  return request;
}

}  // namespace

SolveService::Reactor* SolveService::CreateSolve(Context* context, const v1::CreateSolveRequest* request, v1::Solve* solve) {
  return answer(context, logger_, "CreateSolve", [&] {
    const Caller caller{tenants_.of(*context), request->request_id()};
    SceneUse scene = scenes_.use(request->parent(), caller.tenant);
    *solve = solves_.create(std::move(scene), request->solve().spec(), caller)->describe();
  });
}

SolveService::Reactor* SolveService::GetSolve(Context* context, const v1::GetSolveRequest* request, v1::Solve* solve) {
  return answer(context, logger_, "GetSolve", [&] { *solve = solves_.find(request->name(), tenants_.of(*context))->describe(); });
}

SolveService::Reactor* SolveService::ListSolves(Context* context, const v1::ListSolvesRequest* request,
                                                v1::ListSolvesResponse* response) {
  return answer(context, logger_, "ListSolves", [&] {
    const std::string tenant = tenants_.of(*context);
    if (request->parent() != "scenes/-") scenes_.find(request->parent(), tenant);
    const auto page = solves_.list(request->parent(), tokens_.request(request->page_size(), request->page_token()), tenant);
    for (const auto& solve : page.items) *response->add_solves() = solve->describe();
    response->set_next_page_token(tokens_.token(page.next_before));
  });
}

SolveService::Reactor* SolveService::CancelSolve(Context* context, const v1::CancelSolveRequest* request, v1::Solve* solve) {
  return answer(context, logger_, "CancelSolve",
                [&] { *solve = solves_.cancel(request->name(), tenants_.of(*context))->describe(); });
}

SolveService::Reactor* SolveService::PauseSolve(Context* context, const v1::PauseSolveRequest* request, v1::Solve* solve) {
  return answer(context, logger_, "PauseSolve",
                [&] { *solve = solves_.pause(request->name(), tenants_.of(*context))->describe(); });
}

SolveService::Reactor* SolveService::ResumeSolve(Context* context, const v1::ResumeSolveRequest* request, v1::Solve* solve) {
  return answer(context, logger_, "ResumeSolve",
                [&] { *solve = solves_.resume(request->name(), tenants_.of(*context))->describe(); });
}

SolveService::Reactor* SolveService::DeleteSolve(Context* context, const v1::DeleteSolveRequest* request,
                                                 google::protobuf::Empty*) {
  return answer(context, logger_, "DeleteSolve", [&] { solves_.remove(request->name(), tenants_.of(*context)); });
}

grpc::ServerWriteReactor<grpc::ByteBuffer>* SolveService::WatchSolve(Context* context, const grpc::ByteBuffer* request) {
  auto* call = new WatchCall(*context, watches_, logger_);  // deletes itself
  const grpc::Status status = attempt(logger_, "WatchSolve", [&] {
    const v1::WatchSolveRequest watch = parse(*request);
    call->start(solves_.find(watch.name(), tenants_.of(*context)), watch);
  });
  if (!status.ok()) call->Finish(status);
  return call;
}

SolveService::Reactor* SolveService::AcknowledgeFrame(Context* context, const v1::AcknowledgeFrameRequest* request,
                                                      v1::AcknowledgeFrameResponse*) {
  return answer(context, logger_, "AcknowledgeFrame", [&] {
    watches_.acknowledge(request->watch_id(), request->frame_count(), request->revision(), tenants_.of(*context));
  });
}

}  // namespace alvor
