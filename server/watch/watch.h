#pragma once
// One watcher of a solve: decides when it gets its next frame. Does not use the network.

#include "alvor/v1/solve_service.pb.h"
#include "server/base/mutex.h"
#include "server/watch/frame_source.h"

#include <grpcpp/support/status.h>

#include <atomic>
#include <chrono>
#include <limits>
#include <memory>
#include <optional>
#include <string>

namespace alvor {

/// The receiver of a watch's frames. Its functions are called with the watch's lock held and must not call the watch.
class FrameSink {
 public:
  /// The reader has taken nothing for too long: ends the write under way. written(false) will follow.
  virtual void give_up() = 0;
  /// Sends `frame`. Requires: written() was called for the frame before.
  virtual void write(const Frame& frame) = 0;
  /// Ends the stream with `status`; no call follows. The sink may be destroyed when it returns.
  virtual void finish(const grpc::Status& status) = 0;

 protected:
  ~FrameSink() = default;
};

/// The parameters of a watch, from its request.
struct WatchPlan {
  Detail detail = Detail::exact;
  Cursor start;
  std::chrono::steady_clock::duration min_interval{};  ///< least time between rounds
  bool follows_edits = false;                          ///< goes on when the solve has ended
  double max_bytes_per_s = std::numeric_limits<double>::infinity();
};

/// A watcher of a solve. Thread-safe. Events only note what happened; take_turn() alone decides what to write, and writes under
/// the lock under which it decided, so the sink is never written to after it was finished. Whoever causes an event must call
/// ask_for_turn() and run the turn.
class Watch {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::uint64_t window = 2;                    ///< most frames that are sent and not acknowledged
  static constexpr std::chrono::seconds bookmark_interval{10};  ///< silence after which an empty frame is sent
  static constexpr std::chrono::seconds patience{60};           ///< longest time for one write; then the watcher is given up

  /// Requires: the sink lives until its finish() was called.
  Watch(std::shared_ptr<FrameSource> frames, const WatchPlan& plan, FrameSink& sink);

  /// Notes that a turn is wanted. Returns false if a turn was already asked for and has not begun.
  bool ask_for_turn() { return !turn_asked_.exchange(true); }
  /// Writes the next frame if there is one, the window is open and the rate limit allows it. The first frame is written at once,
  /// even if it is empty, because it carries the watch's id. Returns when to take another turn if no event happens until then.
  std::optional<Clock::time_point> take_turn(Clock::time_point now);

  /// Says that the sink can take another frame (`ok`), or never will again.
  void written(bool ok);
  /// Notes that the watcher applied the first `frame_count` frames. Throws StatusError INVALID_ARGUMENT for frames that were
  /// never sent.
  void acknowledge(std::uint64_t frame_count, std::uint64_t revision);
  /// Ends the watch at its next turn, if it has not ended otherwise.
  void stop(const grpc::Status& reason);
  /// Ends the watch at its next turn, after a frame with `closing`.
  void close(const v1::Closing& closing);

  std::uint64_t frames_sent() const;
  std::uint64_t bytes_sent() const;
  /// Returns the number of revisions that the watcher has not acknowledged.
  std::uint64_t revisions_behind() const;

 private:
  std::optional<Clock::time_point> wait_until(Clock::time_point due) ALVOR_REQUIRES(lock_);
  std::optional<Clock::time_point> see_to_write(Clock::time_point now) ALVOR_REQUIRES(lock_);
  bool is_window_open() const ALVOR_REQUIRES(lock_) { return sent_ - acknowledged_ < window; }
  Clock::time_point next_due() const ALVOR_REQUIRES(lock_);
  void send(Clock::time_point now) ALVOR_REQUIRES(lock_);
  void write(std::shared_ptr<const Frame> frame, Clock::time_point now) ALVOR_REQUIRES(lock_);
  void finish(const grpc::Status& status) ALVOR_REQUIRES(lock_);

  const std::shared_ptr<FrameSource> frames_;
  const WatchPlan plan_;
  FrameSink& sink_;
  std::atomic<bool> turn_asked_ = false;

  mutable Mutex lock_;
  Cursor cursor_ ALVOR_GUARDED_BY(lock_);
  std::uint64_t sent_ ALVOR_GUARDED_BY(lock_) = 0, acknowledged_ ALVOR_GUARDED_BY(lock_) = 0, bytes_ ALVOR_GUARDED_BY(lock_) = 0;
  std::uint64_t acknowledged_revision_ ALVOR_GUARDED_BY(lock_);
  bool has_told_end_ ALVOR_GUARDED_BY(lock_) = false;               ///< the newest frame said that the solve has ended
  std::uint64_t sent_revision_ ALVOR_GUARDED_BY(lock_);             ///< to_revision of the newest frame
  std::shared_ptr<const Frame> under_way_ ALVOR_GUARDED_BY(lock_);  ///< the frame being written, from write() to written()
  std::optional<grpc::Status> end_ ALVOR_GUARDED_BY(lock_);         ///< the status to finish with once no frame is being written
  bool finished_ ALVOR_GUARDED_BY(lock_) = false;
  std::optional<v1::Closing> closing_ ALVOR_GUARDED_BY(lock_);  ///< to be written before the end
  Clock::time_point last_write_ ALVOR_GUARDED_BY(lock_) = Clock::time_point::min(), next_frame_ ALVOR_GUARDED_BY(lock_) =
                                                                                        Clock::time_point::min();
  std::optional<Clock::time_point> write_check_
      ALVOR_GUARDED_BY(lock_);  ///< when the newest turn was asked for that checks on the write
  std::optional<Clock::time_point> timer_ ALVOR_GUARDED_BY(lock_);  ///< when the turn is due that wait_until() asked for last
};

}  // namespace alvor
