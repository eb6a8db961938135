#include "bench/service/watching.h"

#include "alvor/v1/solve_service.grpc.pb.h"
#include "proto/codec.h"

#include <grpcpp/grpcpp.h>

namespace alvor::bench {

double now_s() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

std::vector<Arrival> watch(const std::string& address, const std::string& solve, double rate_hz) {
  grpc::ChannelArguments own;
  own.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
  const auto stub = v1::SolveService::NewStub(grpc::CreateCustomChannel(address, grpc::InsecureChannelCredentials(), own));
  grpc::ClientContext context;
  v1::WatchSolveRequest request;
  request.set_name(solve);
  request.set_detail(v1::DETAIL_DISPLAY);
  request.set_max_rate_hertz(rate_hz);
  const auto reader = stub->WatchSolve(&context, request);
  std::vector<Arrival> arrivals;
  for (v1::WatchSolveResponse frame; reader->Read(&frame);) {
    arrivals.push_back({now_s(), frame.steps().empty() ? -1 : decode_seconds(frame.steps().rbegin()->elapsed()),
                        frame.ByteSizeLong(), frame.to_revision(), frame.head_revision()});
    if (frame.ended()) break;
    grpc::ClientContext acknowledging;
    v1::AcknowledgeFrameRequest applied;
    applied.set_watch_id(frame.watch_id());
    applied.set_frame_count(arrivals.size());
    applied.set_revision(frame.to_revision());
    v1::AcknowledgeFrameResponse nothing;
    (void)stub->AcknowledgeFrame(&acknowledging, applied, &nothing);
  }
  context.TryCancel();
  return arrivals;
}

}  // namespace alvor::bench
