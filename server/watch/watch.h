#pragma once
// One watcher of a solve: when it gets its next frame, without the network.

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

/// Where frames go. Called with the watch's lock held: must not call back into the watch.
class FrameSink {
 public:
  /// Whoever should read has not done so for too long: written(false) will follow.
  virtual void give_up() = 0;
  /// Requires: written() was called for the frame before.
  virtual void write(const Frame& frame) = 0;
  /// Nothing follows it; the sink may be gone when it returns.
  virtual void finish(const grpc::Status& status) = 0;

 protected:
  ~FrameSink() = default;
};

/// What a watcher asked for.
struct WatchPlan {
  Detail detail = Detail::exact;
  Cursor start;
  std::chrono::steady_clock::duration min_interval{};  ///< between rounds
  double max_bytes_per_s = std::numeric_limits<double>::infinity();
};

/// Thread-safe. Events only note what happened; take_turn alone decides, and writes under the lock it decided under, so that the
/// sink is never written to after it was finished. Whoever causes an event has to see to it that a turn follows.
class Watch {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::uint64_t window = 2;                    ///< frames under way that were not acknowledged
  static constexpr std::chrono::seconds bookmark_interval{10};  ///< of silence
  static constexpr std::chrono::seconds patience{60};           ///< with a write that does not end

  /// The sink must live until finish() was called.
  Watch(std::shared_ptr<FrameSource> frames, const WatchPlan& plan, FrameSink& sink);

  /// False if a turn was asked for already and has not begun.
  bool ask_for_turn() { return !turn_asked_.exchange(true); }
  /// Writes the next frame if there is one to write, the window is open and the pace allows it. The first frame is written at
  /// once, even if it is empty: it tells the watch's id. Returns when another turn is due if nothing happens until then.
  std::optional<Clock::time_point> take_turn(Clock::time_point now);

  /// The sink is ready for another frame, or will never be.
  void written(bool ok);
  /// Frames up to the `frame_count`th were applied. Throws StatusError INVALID_ARGUMENT for frames that were never sent.
  void acknowledge(std::uint64_t frame_count, std::uint64_t revision);
  /// Ends the watch at its next turn, if it has not ended otherwise.
  void stop(const grpc::Status& reason);
  /// The same, after a frame that says so.
  void close(const v1::Closing& closing);

  std::uint64_t frames_sent() const;
  std::uint64_t bytes_sent() const;
  /// How many revisions there are that the watcher has not acknowledged.
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
  std::uint64_t sent_revision_ ALVOR_GUARDED_BY(lock_);             ///< to_revision of the newest frame
  std::shared_ptr<const Frame> under_way_ ALVOR_GUARDED_BY(lock_);  ///< set between write() and written()
  std::optional<grpc::Status> end_ ALVOR_GUARDED_BY(lock_);         ///< why to finish once nothing is under way
  bool finished_ ALVOR_GUARDED_BY(lock_) = false;
  std::optional<v1::Closing> closing_ ALVOR_GUARDED_BY(lock_);  ///< to be written before the end
  Clock::time_point last_write_ ALVOR_GUARDED_BY(lock_) = Clock::time_point::min(), next_frame_ ALVOR_GUARDED_BY(lock_) =
                                                                                        Clock::time_point::min();
  std::optional<Clock::time_point> write_check_
      ALVOR_GUARDED_BY(lock_);                                      ///< the newest turn that was asked for to see to a write
  std::optional<Clock::time_point> timer_ ALVOR_GUARDED_BY(lock_);  ///< the turn that was last asked for by wait_until
};

}  // namespace alvor
