#include "server/web/web_call.h"

#include "server/access/tenants.h"

#include <utility>

namespace alvor {

WebCall::WebCall(const Options& options, std::shared_ptr<Listener> listener) : listener_(std::move(listener)) {
  context_.AddMetadata(tenant_key(), options.tenant);
  if (options.deadline) context_.set_deadline(*options.deadline);
}

template <class Begin>
void WebCall::take(Step step, Begin begin) {
  const Lock lock(mutex_);
  if (is_over_) return;  // has_ended() will be called
  step_ = step;
  begin();
}

void WebCall::write(const grpc::ByteBuffer& message) {
  take(Step::write, [&] { call_->Write(message, this); });
}

void WebCall::end_request() {
  take(Step::write, [&] { call_->WritesDone(this); });
}

void WebCall::read() {
  take(Step::read, [&] { call_->Read(&message_, this); });
}

void WebCall::cancel() {
  const Lock lock(mutex_);
  context_.TryCancel();
  if (!std::exchange(is_over_, true) && step_ == Step::none) begin_finish();
}

/// Starts the last step. Requires: the lock, and no step under way.
void WebCall::begin_finish() {
  is_over_ = true;
  step_ = Step::finish;
  call_->Finish(&status_, this);
}

void WebCall::step_done(bool ok) {
  Step done;
  {
    const Lock lock(mutex_);
    done = std::exchange(step_, Step::none);
    if (done != Step::finish && (!ok || is_over_)) return begin_finish();
  }
  if (done != Step::finish)
    return done == Step::read ? listener_->has_read(std::exchange(message_, {})) : listener_->has_written();
  const auto self = std::move(self_);
  std::exchange(listener_, nullptr)->has_ended(status_);
}

WebCalls::WebCalls(std::shared_ptr<grpc::Channel> channel)
    : stub_(std::move(channel)), thread_([this] {
        bool ok = false;
        for (void* call = nullptr; queue_.Next(&call, &ok);) static_cast<WebCall*>(call)->step_done(ok);
      }) {}

WebCalls::~WebCalls() {
  queue_.Shutdown();
  thread_.join();
}

std::shared_ptr<WebCall> WebCalls::start(const WebCall::Options& options, std::shared_ptr<WebCall::Listener> listener) {
  const std::shared_ptr<WebCall> call(new WebCall(options, std::move(listener)));
  call->self_ = call;
  call->call_ = stub_.PrepareCall(&call->context_, options.method, &queue_);
  call->take(WebCall::Step::start, [&] { call->call_->StartCall(call.get()); });
  return call;
}

}  // namespace alvor
