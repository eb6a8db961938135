#include "server/watch_call.h"

#include "server/random_id.h"
#include "server/status_error.h"

#include <spdlog/spdlog.h>

#include <cmath>

namespace alvor {

namespace {

constexpr double default_rate_hz = 60, least_rate_hz = 0.01;

grpc::Slice id_field(const std::string& id) {
  v1::WatchSolveResponse message;
  message.set_watch_id(id);
  return grpc::Slice(message.SerializeAsString());
}

Watch::Clock::duration interval_of(double rate_hz) {
  if (rate_hz == 0) rate_hz = default_rate_hz;
  if (!(rate_hz >= least_rate_hz)) throw invalid_argument("max_rate_hertz: must be 0 or at least 0.01");
  return std::chrono::duration_cast<Watch::Clock::duration>(std::chrono::duration<double>(1 / rate_hz));
}

// A revision of another epoch says nothing here.
Cursor start_of(const v1::WatchSolveRequest& request, const std::string& epoch, const SolutionLog& log) {
  if (request.epoch() != epoch) return {};
  const Cursor start{.revision = request.base_revision()};
  if (const std::uint64_t head = log.head(); start.revision > head)
    throw StatusError(grpc::OUT_OF_RANGE,
                      "base_revision: " + std::to_string(start.revision) + " is beyond the newest, " + std::to_string(head));
  return start;
}

}  // namespace

WatchCall::WatchCall(Watches& watches, spdlog::logger& logger)
    : watches_(watches), logger_(logger), id_(random_id('w')), id_field_(id_field(id_)) {}

void WatchCall::start(const std::shared_ptr<StoredSolve>& solve, const v1::WatchSolveRequest& request) {
  const Cursor start = start_of(request, watches_.epoch(), solve->log);
  const auto interval = interval_of(request.max_rate_hertz());
  auto watch = std::make_shared<Watch>(watches_.frames_of(solve), start, interval, *this);
  // Known by its id before its first frame can be acknowledged.
  watches_.add(id_, watch);
  solve_ = solve;
  watch_ = watch;
  listener_ = solve->log.listen([&watches = watches_, watch] { watches.ask_for_turn(watch); });
  watches_.ask_for_turn(watch_);
  logger_.info("watcher {} of {} joined at revision {}", id_, solve->name, start.revision);
}

void WatchCall::write(const Frame& frame) {
  const grpc::Slice parts[] = {frame.bytes, id_field_};
  bytes_ = grpc::ByteBuffer(parts, 2);
  StartWrite(&bytes_);
}

void WatchCall::OnWriteDone(bool ok) {
  watch_->written(ok);
  watches_.ask_for_turn(watch_);
}

void WatchCall::OnCancel() {
  if (!watch_) return;
  watch_->stop({grpc::CANCELLED, "the watcher has gone"});
  watches_.ask_for_turn(watch_);
}

// No lock is held here: forget() waits for a listener that is just running.
void WatchCall::OnDone() {
  if (watch_) {
    watches_.remove(id_);
    solve_->log.forget(listener_);
    logger_.info("watcher {} of {} left after {} frames", id_, solve_->name, watch_->frames_sent());
  }
  delete this;
}

}  // namespace alvor
