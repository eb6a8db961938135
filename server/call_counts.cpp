#include "server/call_counts.h"

namespace alvor {

namespace {

using grpc::experimental::InterceptionHookPoints;

class Counting final : public grpc::experimental::Interceptor {
 public:
  Counting(CallCounts& counts, std::string method) : counts_(counts), method_(std::move(method)) {}
  void Intercept(grpc::experimental::InterceptorBatchMethods* methods) override {
    if (methods->QueryInterceptionHookPoint(InterceptionHookPoints::PRE_SEND_STATUS)) note(methods->GetSendStatus().error_code());
    methods->Proceed();
  }

 private:
  /// Clients may make up as many methods as they like.
  void note(grpc::StatusCode code) { counts_.note(code == grpc::UNIMPLEMENTED ? "other" : method_, code); }

  CallCounts& counts_;
  const std::string method_;
};

class Factory final : public grpc::experimental::ServerInterceptorFactoryInterface {
 public:
  explicit Factory(CallCounts& counts) : counts_(counts) {}
  grpc::experimental::Interceptor* CreateServerInterceptor(grpc::experimental::ServerRpcInfo* call) override {
    return new Counting(counts_, call->method());
  }

 private:
  CallCounts& counts_;
};

}  // namespace

void CallCounts::note(const std::string& method, grpc::StatusCode code) {
  std::scoped_lock hold(lock_);
  ++counts_[{method, code}];
}

CallCounts::Counts CallCounts::counts() const {
  std::scoped_lock hold(lock_);
  return counts_;
}

std::unique_ptr<grpc::experimental::ServerInterceptorFactoryInterface> counting_calls(CallCounts& counts) {
  return std::make_unique<Factory>(counts);
}

}  // namespace alvor
