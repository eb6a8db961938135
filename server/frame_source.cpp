#include "server/frame_source.h"

#include "proto/codec.h"

namespace alvor {

FrameSource::FrameSource(std::shared_ptr<StoredSolve> solve, std::string epoch, std::size_t max_leaves)
    : solve_(std::move(solve)), epoch_(std::move(epoch)), max_leaves_(max_leaves) {}

bool FrameSource::has_news(const Cursor& cursor) const {
  const bool is_inside_revision = cursor.patch != Cursor{}.patch;
  return is_inside_revision || solve_->log.head() > cursor.revision || solve_->ended();
}

std::shared_ptr<const Frame> FrameSource::frame_after(const Cursor& cursor) {
  // Asked before the log is: once the solve has ended, what the log then gives is all there will be.
  const bool ended = solve_->ended();
  std::scoped_lock hold(lock_);
  const std::uint64_t head = solve_->log.head();
  for (const auto& weak : recent_) {
    const auto frame = weak.lock();
    const bool is_whole = frame && frame->next == Cursor{frame->head};
    if (frame && frame->from == cursor && frame->head == head && frame->last == (ended && is_whole)) return frame;
  }
  auto frame = encode_frame(cursor, ended);
  recent_[oldest_++ % recent_.size()] = frame;
  return frame;
}

std::shared_ptr<const Frame> FrameSource::encode_frame(const Cursor& cursor, bool ended) const {
  const Delta delta = solve_->log.since(cursor, max_leaves_);
  v1::WatchSolveResponse message;
  message.set_epoch(epoch_);
  encode(delta, message);
  const bool last = ended && delta.whole();
  message.set_ended(last);
  if (last) *message.mutable_solve() = solve_->describe();
  return std::make_shared<const Frame>(
      Frame{grpc::Slice(message.SerializeAsString()), cursor, delta.next, delta.to_revision, delta.head, last});
}

}  // namespace alvor
