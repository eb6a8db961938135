#include "server/watch/frame_source.h"

#include "proto/codec.h"
#include "proto/leaf_codec.h"
#include "server/archive/record_codec.h"

#include <algorithm>

namespace alvor {

FrameSource::FrameSource(std::shared_ptr<StoredSolve> solve, std::string epoch, std::size_t max_leaves)
    : solve_(std::move(solve)), log_(solve_->log()), epoch_(std::move(epoch)), max_leaves_(max_leaves) {}

bool FrameSource::has_news(const Cursor& cursor, bool has_told_end) const {
  return cursor.is_inside_round() || log_->head() > cursor.base || log_->has_errors_after(cursor.errors) ||
         (solve_->ended() && !has_told_end);
}

std::shared_ptr<const Frame> FrameSource::frame_after(const Cursor& cursor, Detail detail) {
  // Ask this before reading the log: if the solve has ended, the log then holds all there will ever be.
  const bool ended = solve_->ended();
  Lock hold(lock_);
  const std::uint64_t head = log_->head();
  for (const auto& weak : recent_) {
    const auto frame = weak.lock();
    if (!frame || frame->from != cursor || frame->detail != detail || frame->head != head) continue;
    if (frame->last == (ended && frame->is_complete)) return frame;
  }
  auto frame = encode_frame(cursor, detail, ended);
  recent_[oldest_++ % recent_.size()] = frame;
  return frame;
}

/// A look comes before the first leaves of a round, as they may be of added objects; and again with leaves of those where edits
/// were made since.
bool FrameSource::is_look_needed(const Cursor& cursor, const Delta& delta) const {
  if (!cursor.is_inside_round()) return delta.edits_after != delta.edits_before;
  if (delta.values.empty() || solve_->newest_edits() == delta.edits_after) return false;
  return delta.values.back().patch.root_face() >= solve_->submitted_roots();
}

std::shared_ptr<const Frame> FrameSource::encode_frame(const Cursor& cursor, Detail detail, bool ended) const {
  const Delta delta = log_->since(cursor, detail, std::min(max_leaves_, leaves_per_frame(detail)));
  v1::WatchSolveResponse message;
  message.set_epoch(epoch_);
  encode(delta, message);
  const bool is_complete = delta.whole() && !delta.has_more_errors, last = ended && is_complete;
  message.set_ended(last);
  if (is_look_needed(cursor, delta)) *message.mutable_look() = solve_->look();
  if (last) *message.mutable_solve() = encode(solve_->describe());
  return std::make_shared<const Frame>(Frame{grpc::Slice(message.SerializeAsString()), detail, cursor, delta.next,
                                             delta.to_revision, delta.head, is_complete, last});
}

std::shared_ptr<const Frame> FrameSource::closing_frame(const Cursor& cursor, const v1::Closing& closing) const {
  v1::WatchSolveResponse message;
  message.set_epoch(epoch_);
  message.set_from_revision(cursor.base);
  message.set_to_revision(cursor.base);
  message.set_head_revision(log_->head());
  *message.mutable_closing() = closing;
  return std::make_shared<const Frame>(
      Frame{.bytes = grpc::Slice(message.SerializeAsString()), .from = cursor, .next = cursor, .to_revision = cursor.base});
}

}  // namespace alvor
