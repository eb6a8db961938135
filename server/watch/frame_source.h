#pragma once
// Encodes the frames of one solve, each once for all its watchers.

#include "alvor/v1/solve_service.pb.h"
#include "server/base/mutex.h"
#include "server/solves/stored_solve.h"

#include <grpcpp/support/slice.h>

#include <array>
#include <memory>
#include <string>

namespace alvor {

/// An encoded WatchSolveResponse, without the fields that differ from watcher to watcher.
struct Frame {
  grpc::Slice bytes;
  Detail detail = Detail::exact;
  Cursor from, next;
  std::uint64_t to_revision = 0;
  std::uint64_t head = 0;
  bool is_complete = false;  ///< nothing that the watcher wants is left at `head`
  bool last = false;         ///< the frame's `ended` is set
};

/// Encodes the frames of one solve and shares them between watchers. Thread-safe.
class FrameSource {
 public:
  /// Keeps the solve's log in memory. A frame holds at most `max_leaves` leaves, and at most leaves_per_frame(). Throws
  /// StatusError if the log cannot be loaded.
  FrameSource(std::shared_ptr<StoredSolve> solve, std::string epoch, std::size_t max_leaves = SolutionLog::unlimited);

  StoredSolve& solve() const { return *solve_; }
  /// Returns the newest revision of the log.
  std::uint64_t head() const { return log_->head(); }
  /// Returns whether frame_after(cursor) would hold anything new for a watcher at `cursor`, to which the end of the solve has
  /// been told already or not.
  bool has_news(const Cursor& cursor, bool has_told_end = false) const;
  /// Returns the frame that follows `cursor`. Watchers at the same cursor get the same frame, for as long as one of them keeps
  /// it.
  std::shared_ptr<const Frame> frame_after(const Cursor& cursor, Detail detail);
  /// Returns a frame that says only that the server stops.
  std::shared_ptr<const Frame> closing_frame(const Cursor& cursor, const v1::Closing& closing) const;

 private:
  bool is_look_needed(const Cursor& cursor, const Delta& delta) const;
  std::shared_ptr<const Frame> encode_frame(const Cursor& cursor, Detail detail, bool ended) const;

  const std::shared_ptr<StoredSolve> solve_;
  const std::shared_ptr<SolutionLog> log_;
  const std::string epoch_;
  const std::size_t max_leaves_;
  Mutex lock_;
  std::array<std::weak_ptr<const Frame>, 4> recent_
      ALVOR_GUARDED_BY(lock_);  ///< watchers in step need one, pages and stragglers a few
  std::size_t oldest_ ALVOR_GUARDED_BY(lock_) = 0;
};

}  // namespace alvor
