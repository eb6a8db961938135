#include "server/rpc/call_counts.h"

#include <grpcpp/server_context.h>

namespace alvor {

namespace {

using grpc::experimental::InterceptionHookPoints;

class Counting final : public grpc::experimental::Interceptor {
 public:
  Counting(CallCounts& counts, std::string method, std::string peer)
      : counts_(counts), method_(std::move(method)), peer_(std::move(peer)) {
    counts_.begin(peer_);
  }
  ~Counting() override { counts_.end(peer_); }
  void Intercept(grpc::experimental::InterceptorBatchMethods* methods) override {
    if (methods->QueryInterceptionHookPoint(InterceptionHookPoints::PRE_SEND_STATUS)) note(methods->GetSendStatus().error_code());
    methods->Proceed();
  }

 private:
  /// Counts the call; calls to unknown methods count together, because clients can invent any number of names.
  void note(grpc::StatusCode code) { counts_.note(code == grpc::UNIMPLEMENTED ? "other" : method_, code); }

  CallCounts& counts_;
  const std::string method_, peer_;
};

class Factory final : public grpc::experimental::ServerInterceptorFactoryInterface {
 public:
  explicit Factory(CallCounts& counts) : counts_(counts) {}
  grpc::experimental::Interceptor* CreateServerInterceptor(grpc::experimental::ServerRpcInfo* call) override {
    return new Counting(counts_, call->method(), call->server_context()->peer());
  }

 private:
  CallCounts& counts_;
};

}  // namespace

void CallCounts::note(const std::string& method, grpc::StatusCode code) {
  Lock hold(lock_);
  ++counts_[{method, code}];
}

void CallCounts::begin(const std::string& peer) {
  {
    Lock hold(lock_);
    if (++under_way_[peer] <= most_of_connection || !peer.starts_with("ip")) return;  // other peers are proxies for many
  }
  flooding_(peer);
}

void CallCounts::end(const std::string& peer) {
  Lock hold(lock_);
  const auto found = under_way_.find(peer);
  if (--found->second == 0) under_way_.erase(found);
}

CallCounts::Counts CallCounts::counts() const {
  Lock hold(lock_);
  return counts_;
}

std::unique_ptr<grpc::experimental::ServerInterceptorFactoryInterface> counting_calls(CallCounts& counts) {
  return std::make_unique<Factory>(counts);
}

}  // namespace alvor
