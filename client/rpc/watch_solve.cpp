// Client::watch_solve: receives the streamed solution.

#include "client/rpc/client.h"
#include "proto/codec.h"
#include "proto/leaf_codec.h"

namespace alvor {

namespace {

[[noreturn]] void lost(const std::string& reason) { throw RpcError({grpc::DATA_LOSS, "a frame does not fit: " + reason}); }

v1::WatchSolveRequest request_for(const std::string& name, Client::Watch& watch) {
  // A mirror in the middle of a round is thrown away: a restarted server may continue from an earlier revision.
  if (watch.is_inside_round) watch = {.detail = watch.detail, .with_errors = watch.with_errors};
  v1::WatchSolveRequest request;
  request.set_name(name);
  request.set_epoch(watch.epoch);
  request.set_base_revision(watch.mirror.revision());
  request.set_detail(encode(watch.detail));
  request.set_with_errors(watch.with_errors);
  return request;
}

void apply(const v1::WatchSolveResponse& frame, Client::Watch& watch) {
  if (frame.reset()) watch.mirror = {};
  watch.epoch = frame.epoch();
  Delta delta;
  if (const auto fault = decode(frame, delta)) lost(fault->text());
  if (const auto fault = watch.mirror.apply(delta)) {
    watch.mirror = {};
    lost(*fault);
  }
  watch.is_inside_round = delta.to_revision == delta.from_revision && !delta.values.empty();
}

// Acknowledges a frame. NOT_FOUND means that the watch has just ended, which is no error.
void acknowledge(v1::SolveService::Stub& solves, const v1::WatchSolveResponse& frame, std::uint64_t frame_count) {
  grpc::ClientContext context;
  v1::AcknowledgeFrameRequest request;
  request.set_watch_id(frame.watch_id());
  request.set_revision(frame.to_revision());
  request.set_frame_count(frame_count);
  v1::AcknowledgeFrameResponse nothing;
  const grpc::Status status = solves.AcknowledgeFrame(&context, request, &nothing);
  if (!status.ok() && status.error_code() != grpc::NOT_FOUND) throw RpcError(status);
}

// Cancels the call at the end of the scope: it must be over before its reader is destroyed.
struct CancelOnExit {
  grpc::ClientContext& context;
  ~CancelOnExit() { context.TryCancel(); }
};

}  // namespace

v1::Solve Client::watch_solve(const std::string& name, Watch& watch, const std::function<void(const Watch&)>& on_frame,
                              std::stop_token stop) {
  grpc::ClientContext context;
  const auto reader = solves_->WatchSolve(&context, request_for(name, watch));
  const CancelOnExit cancel{context};
  const std::stop_callback cancel_on_stop(stop, [&] { context.TryCancel(); });
  std::uint64_t frames = 0;
  for (v1::WatchSolveResponse frame; !stop.stop_requested() && reader->Read(&frame);) {
    apply(frame, watch);
    ++frames;
    if (!frame.ended() && !frame.has_closing()) acknowledge(*solves_, frame, frames);
    on_frame(watch);
    if (!frame.ended()) continue;
    (void)reader->Finish();  // everything has arrived, so the status does not matter
    return frame.solve();
  }
  if (stop.stop_requested()) return get_solve(name);
  const grpc::Status status = reader->Finish();
  throw RpcError(status.ok() ? grpc::Status(grpc::DATA_LOSS, "the stream ended before the solve did") : status);
}

}  // namespace alvor
