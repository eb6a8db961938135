#include "server/watch.h"

#include "server/status_error.h"

namespace alvor {

Watch::Watch(std::shared_ptr<FrameSource> frames, Cursor start, Clock::duration min_interval, FrameSink& sink)
    : frames_(std::move(frames)), min_interval_(min_interval), sink_(sink), cursor_(start), sent_revision_(start.revision) {}

std::optional<Watch::Clock::time_point> Watch::take_turn(Clock::time_point now) {
  turn_asked_ = false;  // before anything is looked at: what happens from here on asks again
  std::scoped_lock hold(lock_);
  if (timer_ && now >= *timer_) timer_.reset();
  if (finished_ || under_way_) return std::nullopt;
  if (end_) {
    finish(*end_);
    return std::nullopt;
  }
  if (!may_send()) return std::nullopt;
  if (now < next_frame_) return wait_until(next_frame_);
  send(now);
  return std::nullopt;
}

bool Watch::may_send() const { return sent_ - acknowledged_ < window && (sent_ == 0 || frames_->has_news(cursor_)); }

// One pending timer is enough: later turns for the same wait ask for none.
std::optional<Watch::Clock::time_point> Watch::wait_until(Clock::time_point due) {
  if (timer_) return std::nullopt;
  return timer_ = due;
}

void Watch::send(Clock::time_point now) {
  try {
    under_way_ = frames_->frame_after(cursor_);
  } catch (const std::exception& fault) {
    finish({grpc::INTERNAL, std::string("cannot encode a frame: ") + fault.what()});
    return;
  }
  ++sent_;
  cursor_ = under_way_->next;
  sent_revision_ = under_way_->to_revision;
  next_frame_ = now + min_interval_;
  if (under_way_->last) end_ = grpc::Status::OK;
  sink_.write(*under_way_);
}

void Watch::finish(const grpc::Status& status) {
  finished_ = true;
  sink_.finish(status);
}

void Watch::written(bool ok) {
  std::scoped_lock hold(lock_);
  under_way_.reset();
  if (!ok) end_ = grpc::Status(grpc::CANCELLED, "the watcher has gone");
}

void Watch::acknowledge(std::uint64_t frame_count, std::uint64_t revision) {
  std::scoped_lock hold(lock_);
  const auto refuse = [](const char* field, std::uint64_t got, std::uint64_t newest) {
    throw invalid_argument(std::string(field) + ": " + std::to_string(got) + " was not sent, the newest is " +
                           std::to_string(newest));
  };
  if (frame_count == 0 || frame_count > sent_) refuse("frame_count", frame_count, sent_);
  if (revision > sent_revision_) refuse("revision", revision, sent_revision_);
  acknowledged_ = std::max(acknowledged_, frame_count);
}

void Watch::stop(const grpc::Status& reason) {
  std::scoped_lock hold(lock_);
  if (!end_) end_ = reason;
}

std::uint64_t Watch::frames_sent() const {
  std::scoped_lock hold(lock_);
  return sent_;
}

}  // namespace alvor
