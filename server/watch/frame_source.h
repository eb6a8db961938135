#pragma once
// The frames of one solve, encoded once for all who watch it.

#include "server/base/mutex.h"
#include "server/solves/stored_solve.h"

#include <grpcpp/support/slice.h>

#include <array>
#include <memory>
#include <string>

namespace alvor {

/// One WatchSolveResponse, all but what is a watcher's own, as it goes over the wire.
struct Frame {
  grpc::Slice bytes;
  Detail detail = Detail::exact;
  Cursor from, next;
  std::uint64_t to_revision = 0;
  std::uint64_t head = 0;
  bool last = false;  ///< `ended` is set in it
};

/// Thread-safe.
class FrameSource {
 public:
  /// Keeps the solve's log in memory. `max_leaves` to a frame, if that is less than what a frame holds. Throws StatusError where
  /// the log cannot be loaded.
  FrameSource(std::shared_ptr<StoredSolve> solve, std::string epoch, std::size_t max_leaves = SolutionLog::unlimited);

  StoredSolve& solve() const { return *solve_; }
  /// The newest revision there is.
  std::uint64_t head() const { return log_->head(); }
  /// Whether frame_after(cursor) would say anything that `cursor` does not know.
  bool has_news(const Cursor& cursor) const;
  /// The same frame to all who ask from the same place, for as long as any of them keeps it.
  std::shared_ptr<const Frame> frame_after(const Cursor& cursor, Detail detail);
  /// Says nothing but that the server stops.
  std::shared_ptr<const Frame> closing_frame(const Cursor& cursor, const v1::Closing& closing) const;

 private:
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
