#include "server/rpc/watch_call.h"

#include "proto/leaf_codec.h"
#include "server/base/random_id.h"
#include "server/base/status_error.h"

#include <spdlog/spdlog.h>

#include <cmath>

namespace alvor {

namespace {

constexpr double default_rate_hz = 60, least_rate_hz = 0.01;
constexpr std::uint64_t least_bytes_per_s = 1000;

template <class Set>
grpc::Slice field(Set&& set) {
  v1::WatchSolveResponse message;
  set(message);
  return grpc::Slice(message.SerializeAsString());
}

Watch::Clock::duration interval_of(double rate_hz) {
  if (rate_hz == 0) rate_hz = default_rate_hz;
  if (!(rate_hz >= least_rate_hz)) throw invalid_argument("max_rate_hertz: must be 0 or at least 0.01");
  return std::chrono::duration_cast<Watch::Clock::duration>(std::chrono::duration<double>(1 / rate_hz));
}

WatchPlan plan_of(const v1::WatchSolveRequest& request) {
  WatchPlan plan;
  if (!v1::Detail_IsValid(request.detail())) throw invalid_argument("detail: is not one");
  plan.detail = decode(request.detail());
  plan.start.errors.are_wanted = request.with_errors();
  plan.follows_edits = request.follow_edits();
  plan.min_interval = interval_of(request.max_rate_hertz());
  if (const std::uint64_t bytes = request.max_bytes_per_second(); bytes > 0) {
    if (bytes < least_bytes_per_s) throw invalid_argument("max_bytes_per_second: must be 0 or at least 1000");
    plan.max_bytes_per_s = static_cast<double>(bytes);
  }
  return plan;
}

}  // namespace

WatchCall::WatchCall(grpc::CallbackServerContext& context, Watches& watches, spdlog::logger& logger)
    : context_(context),
      watches_(watches),
      logger_(logger),
      id_(random_id('w')),
      id_field_(field([this](auto& message) { message.set_watch_id(id_); })) {}

void WatchCall::start(const std::shared_ptr<StoredSolve>& solve, const v1::WatchSolveRequest& request) {
  WatchPlan plan = plan_of(request);
  solve_ = solve;
  log_ = solve->log();  // loaded here, where errors can be reported
  if (solve->knows(request.epoch(), request.base_revision())) plan.start.base = request.base_revision();
  else if (request.base_revision() > 0) reset_field_ = field([](auto& message) { message.set_reset(true); });
  const auto watch = std::make_shared<Watch>(watches_.frames_of(solve), plan, *this);
  watch->ask_for_turn();  // reserved until begin(): in an earlier turn the watch could end and delete this call
  watches_.add(id_, watch, solve->creator.tenant);
  listener_ = log_->listen([&watches = watches_, watch] { watches.ask_for_turn(watch); });
  set_watch(watch);
  logger_.info("watcher {} of {} joined at revision {}", id_, solve->name, plan.start.base);
  watches_.begin(watch);
}

void WatchCall::set_watch(const std::shared_ptr<Watch>& watch) {
  Lock hold(lock_);
  if (const grpc::Status why = stop_->reason(); !why.ok()) watch->stop(why);
  watch_ = watch;
}

void WatchCall::write(const Frame& frame) {
  const grpc::Slice parts[] = {frame.bytes, id_field_, reset_field_};
  bytes_ = grpc::ByteBuffer(parts, 3);
  reset_field_ = {};
  StartWrite(&bytes_);
}

void WatchCall::OnWriteDone(bool ok) {
  watch_->written(ok);
  watches_.ask_for_turn(watch_);
}

void WatchCall::OnCancel() {
  const grpc::Status gone(grpc::CANCELLED, "the watcher has gone");
  stop_->stop(gone);
  std::shared_ptr<Watch> watch;
  {
    Lock hold(lock_);
    watch = watch_;
  }
  if (!watch) return;
  watch->stop(gone);
  watches_.ask_for_turn(watch);
}

// Holds no lock: forget() waits for a listener that is running.
void WatchCall::OnDone() {
  if (watch_) {
    watches_.remove(id_);
    log_->forget(listener_);
    logger_.info("watcher {} of {} left after {} frames", id_, solve_->name, watch_->frames_sent());
  }
  watch_.reset();
  if (std::exchange(log_, nullptr)) watches_.release(std::move(solve_));
  delete this;
}

}  // namespace alvor
