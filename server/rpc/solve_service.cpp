#include "server/rpc/solve_service.h"

#include "proto/edit_codec.h"
#include "server/archive/record_codec.h"
#include "server/base/status_error.h"
#include "server/rpc/answer.h"
#include "server/rpc/watch_call.h"

#include <algorithm>

namespace alvor {

namespace {

v1::WatchSolveRequest parse(grpc::ByteBuffer bytes) {
  v1::WatchSolveRequest request;
  if (!grpc::SerializationTraits<v1::WatchSolveRequest>::Deserialize(&bytes, &request).ok())
    throw invalid_argument("the message is not a WatchSolveRequest");
  return request;
}

/// Throws StatusError INVALID_ARGUMENT if a solve names an object that its scene does not have.
void check_objects(const std::vector<std::string>& names, const StoredScene& scene) {
  if (names.empty()) return;
  const auto content = scene.content();
  for (std::size_t n = 0; n < names.size(); ++n)
    if (std::ranges::find(content->scene.objects, names[n], &SceneObject::name) == content->scene.objects.end())
      throw invalid_field("solve.spec.objects[" + std::to_string(n) + "]", "'" + names[n] + "'", "is no object of the scene");
}

/// Returns why a step cannot be decoded.
std::string fault_in(const v1::EditStep& step) {
  for (int n = 0; n < step.edits_size(); ++n) {
    const v1::Edit& edit = step.edits(n);
    if (decode(edit)) continue;
    const std::string field = "step.edits[" + std::to_string(n) + "]";
    if (!edit.has_daylight()) return field + ": has no part that this server knows";
    return field + ".daylight.sky: " + std::to_string(edit.daylight().sky()) + " is none that this server knows";
  }
  return "step.kind: " + std::to_string(step.kind()) + " is none that this server knows";
}

}  // namespace

template <class Body>
SolveService::Reactor* SolveService::keep(Context* context, const char* call, Body body) {
  return answer_from(pools_.keeping, tenants_, context, logger_, call, body);
}

SolveService::Reactor* SolveService::CreateSolve(Context* context, const v1::CreateSolveRequest* request, v1::Solve* solve) {
  return keep(context, "CreateSolve", [this, request, solve](const std::string& tenant) {
    const Caller caller{tenant, request->request_id()};
    SceneUse scene = scenes_.use(request->parent(), tenant);
    const SolveSpec spec = decode(request->solve().spec());
    check_objects(spec.objects, *scene.scene);
    *solve = encode(solves_.create(std::move(scene), spec, caller)->describe());
  });
}

SolveService::Reactor* SolveService::GetSolve(Context* context, const v1::GetSolveRequest* request, v1::Solve* solve) {
  return keep(context, "GetSolve", [this, request, solve](const std::string& tenant) {
    *solve = encode(solves_.find(request->name(), tenant)->describe());
  });
}

SolveService::Reactor* SolveService::ListSolves(Context* context, const v1::ListSolvesRequest* request,
                                                v1::ListSolvesResponse* response) {
  return keep(context, "ListSolves", [this, request, response](const std::string& tenant) {
    if (request->parent() != "scenes/-") scenes_.find(request->parent(), tenant);
    const auto page = solves_.list(request->parent(), tokens_.request(request->page_size(), request->page_token()), tenant);
    for (const auto& solve : page.items) {
      *response->add_solves() = encode(solve->describe());
      response->mutable_solves()->rbegin()->clear_edits();
    }
    response->set_next_page_token(tokens_.token(page.next_before));
  });
}

SolveService::Reactor* SolveService::CancelSolve(Context* context, const v1::CancelSolveRequest* request, v1::Solve* solve) {
  return keep(context, "CancelSolve", [this, request, solve](const std::string& tenant) {
    *solve = encode(solves_.cancel(request->name(), tenant)->describe());
  });
}

SolveService::Reactor* SolveService::PauseSolve(Context* context, const v1::PauseSolveRequest* request, v1::Solve* solve) {
  return keep(context, "PauseSolve", [this, request, solve](const std::string& tenant) {
    *solve = encode(solves_.pause(request->name(), tenant)->describe());
  });
}

SolveService::Reactor* SolveService::ResumeSolve(Context* context, const v1::ResumeSolveRequest* request, v1::Solve* solve) {
  return keep(context, "ResumeSolve", [this, request, solve](const std::string& tenant) {
    *solve = encode(solves_.resume(request->name(), tenant)->describe());
  });
}

SolveService::Reactor* SolveService::EditSolve(Context* context, const v1::EditSolveRequest* request,
                                               v1::EditSolveResponse* response) {
  return keep(context, "EditSolve", [this, request, response](const std::string& tenant) {
    auto step = decode(request->step());
    if (!step) throw invalid_argument(fault_in(request->step()));
    EditRequest edit{std::move(*step), request->step().author(), request->request_id(), request->step().continues(), {}, {}};
    for (const std::string& scene : scenes_added_by(edit.step))
      if (auto use = scenes_.use_if_there(scene, tenant)) edit.added.emplace(scene, std::move(*use));
    if (request->has_base_revision()) edit.base_revision = request->base_revision();
    response->set_revision(solves_.edit(request->name(), edit, tenant));
    response->set_state(encode(solves_.find(request->name(), tenant)->describe()).state());
  });
}

SolveService::Reactor* SolveService::DeleteSolve(Context* context, const v1::DeleteSolveRequest* request,
                                                 google::protobuf::Empty*) {
  return keep(context, "DeleteSolve", [this, request](const std::string& tenant) { solves_.remove(request->name(), tenant); });
}

grpc::ServerWriteReactor<grpc::ByteBuffer>* SolveService::WatchSolve(Context* context, const grpc::ByteBuffer* request) {
  std::string tenant;
  v1::WatchSolveRequest watch;
  const grpc::Status refusal = attempt(logger_, "WatchSolve", [&] {
    tenant = tenants_.of(*context);
    watch = parse(*request);
  });
  if (!refusal.ok()) return new Refusal<grpc::ServerWriteReactor<grpc::ByteBuffer>>(refusal);
  auto* call = new WatchCall(*context, watches_, logger_);  // deletes itself
  const auto start = [this, call, tenant, watch] {
    const auto stop = call->stop();  // kept here: the call may end at any time once started
    const grpc::Status status = attempt(logger_, "WatchSolve", [&] {
      stop->refuse_stopped();
      call->start(solves_.find(watch.name(), tenant), watch);
    });
    if (!status.ok()) call->Finish(status);
  };
  const grpc::Status full =
      attempt(logger_, "WatchSolve", [&] { pools_.watching.post(turn_of(tenant, *context), call->stop(), start); });
  if (!full.ok()) call->Finish(full);
  return call;
}

SolveService::Reactor* SolveService::AcknowledgeFrame(Context* context, const v1::AcknowledgeFrameRequest* request,
                                                      v1::AcknowledgeFrameResponse*) {
  return answer(context, logger_, "AcknowledgeFrame", [&] {
    watches_.acknowledge(request->watch_id(), request->frame_count(), request->revision(), tenants_.of(*context));
  });
}

}  // namespace alvor
