#include "server/watch/watch.h"

#include "server/base/status_error.h"

#include <algorithm>

namespace alvor {

Watch::Watch(std::shared_ptr<FrameSource> frames, const WatchPlan& plan, FrameSink& sink)
    : frames_(std::move(frames)),
      plan_(plan),
      sink_(sink),
      cursor_(plan.start),
      acknowledged_revision_(plan.start.base),
      sent_revision_(plan.start.base) {}

std::optional<Watch::Clock::time_point> Watch::take_turn(Clock::time_point now) {
  turn_asked_ = false;  // reset first: events from here on ask for another turn
  Lock hold(lock_);
  if (timer_ && now >= *timer_) timer_.reset();
  if (finished_) return std::nullopt;
  if (under_way_) return see_to_write(now);
  if (end_ && closing_) {
    write(frames_->closing_frame(cursor_, *closing_), now);
    closing_.reset();
    return std::nullopt;
  }
  if (end_) {
    finish(*end_);
    return std::nullopt;
  }
  if (!is_window_open()) return std::nullopt;
  if (now < next_due()) return wait_until(next_due());
  send(now);
  return see_to_write(now);
}

Watch::Clock::time_point Watch::next_due() const {
  if (sent_ == 0) return Clock::time_point::min();
  return frames_->has_news(cursor_, has_told_end_) ? next_frame_ : std::max(next_frame_, last_write_ + bookmark_interval);
}

std::optional<Watch::Clock::time_point> Watch::see_to_write(Clock::time_point now) {
  if (!under_way_) return std::nullopt;
  if (now >= last_write_ + patience) {
    sink_.give_up();
    return std::nullopt;
  }
  if (write_check_ && *write_check_ > now) return std::nullopt;  // that turn checks again
  return write_check_ = last_write_ + patience;
}

// Returns `due`, or nothing if an earlier turn was already asked for; that turn will ask for the later one.
std::optional<Watch::Clock::time_point> Watch::wait_until(Clock::time_point due) {
  if (timer_ && *timer_ <= due) return std::nullopt;
  return timer_ = due;
}

void Watch::send(Clock::time_point now) {
  std::shared_ptr<const Frame> frame;
  try {
    frame = frames_->frame_after(cursor_, plan_.detail);
  } catch (const std::exception& fault) {
    finish({grpc::INTERNAL, std::string("cannot encode a frame: ") + fault.what()});
    return;
  }
  ++sent_;
  cursor_ = frame->next;
  sent_revision_ = frame->to_revision;
  const std::chrono::duration<double> by_bytes(static_cast<double>(frame->bytes.size()) / plan_.max_bytes_per_s);
  // The pages of a round are sent without a pause, because a mirror between revisions is of little use.
  const auto by_rate = frame->next.is_between_pages() ? Clock::duration::zero() : plan_.min_interval;
  next_frame_ = now + std::max(by_rate, std::chrono::duration_cast<Clock::duration>(by_bytes));
  if (frame->last && (!plan_.follows_edits || frames_->solve().is_removed())) end_ = grpc::Status::OK;
  has_told_end_ = frame->last;
  write(std::move(frame), now);
}

void Watch::write(std::shared_ptr<const Frame> frame, Clock::time_point now) {
  under_way_ = std::move(frame);
  last_write_ = now;
  bytes_ += under_way_->bytes.size();
  sink_.write(*under_way_);
}

void Watch::finish(const grpc::Status& status) {
  finished_ = true;
  sink_.finish(status);
}

void Watch::written(bool ok) {
  Lock hold(lock_);
  under_way_.reset();
  if (ok) return;
  end_ = grpc::Status(grpc::CANCELLED, "the watcher has gone");
  closing_.reset();
}

void Watch::acknowledge(std::uint64_t frame_count, std::uint64_t revision) {
  Lock hold(lock_);
  const auto refuse = [](const char* field, std::uint64_t got, std::uint64_t newest) {
    throw invalid_argument(std::string(field) + ": " + std::to_string(got) + " was not sent, the newest is " +
                           std::to_string(newest));
  };
  if (frame_count == 0 || frame_count > sent_) refuse("frame_count", frame_count, sent_);
  if (revision > sent_revision_) refuse("revision", revision, sent_revision_);
  acknowledged_ = std::max(acknowledged_, frame_count);
  acknowledged_revision_ = std::max(acknowledged_revision_, revision);
}

void Watch::stop(const grpc::Status& reason) {
  Lock hold(lock_);
  if (!end_) end_ = reason;
}

void Watch::close(const v1::Closing& closing) {
  Lock hold(lock_);
  if (end_) return;
  closing_ = closing;
  end_ = grpc::Status(grpc::UNAVAILABLE, closing.reason());
}

std::uint64_t Watch::frames_sent() const {
  Lock hold(lock_);
  return sent_;
}

std::uint64_t Watch::bytes_sent() const {
  Lock hold(lock_);
  return bytes_;
}

std::uint64_t Watch::revisions_behind() const {
  Lock hold(lock_);
  const std::uint64_t head = frames_->head();
  return head - std::min(head, acknowledged_revision_);
}

}  // namespace alvor
