#pragma once
// All watches of the server: finds a watch by its id and runs the turns of all.

#include "server/base/mutex.h"
#include "server/base/task_queue.h"
#include "server/watch/watch.h"

#include <map>
#include <memory>
#include <string>

namespace alvor {

/// The open watches. Thread-safe. All turns run on one thread of its own, so that neither the solver's threads nor gRPC's encode
/// frames.
class Watches {
 public:
  explicit Watches(std::string epoch, std::uint64_t most_per_tenant = Quota{}.watchers)
      : epoch_(std::move(epoch)), most_per_tenant_(most_per_tenant) {}
  const std::string& epoch() const { return epoch_; }

  /// Returns the frame source of `solve`, which all its watchers share.
  std::shared_ptr<FrameSource> frames_of(const std::shared_ptr<StoredSolve>& solve);

  /// Adds a watch under `id`. Throws StatusError: UNAVAILABLE after stop_all(), RESOURCE_EXHAUSTED if the tenant has too many.
  void add(const std::string& id, const std::shared_ptr<Watch>& watch, const std::string& tenant = {});
  void remove(const std::string& id);
  /// Passes an acknowledgement to the watch. Throws StatusError: NOT_FOUND if the watch has ended or is another tenant's,
  /// INVALID_ARGUMENT as in Watch::acknowledge.
  void acknowledge(const std::string& id, std::uint64_t frame_count, std::uint64_t revision, const std::string& tenant = {});
  /// Sums over the watches, for metrics.
  struct Traffic {
    std::size_t watchers = 0;
    std::uint64_t frames = 0, bytes = 0;  ///< since the server was started
    std::uint64_t most_behind = 0;        ///< the most revisions that one watcher has not acknowledged
  };
  Traffic traffic() const;
  /// Ends every watch; add() refuses new ones from now on.
  void stop_all();

  /// Lets the solve unload its log if nobody else watches it. Requires: the caller has given up its watch and its log.
  void release(std::shared_ptr<StoredSolve> solve);
  /// Runs the first turn of a new watch, which must have been asked for already.
  void begin(const std::shared_ptr<Watch>& watch);
  /// Runs a turn of `watch` soon; two calls before that turn are one turn. Quick: may be called from any callback.
  void ask_for_turn(const std::shared_ptr<Watch>& watch);

 private:
  void take_turn(const std::shared_ptr<Watch>& watch);

  struct Entry {
    std::shared_ptr<Watch> watch;
    std::string tenant;
  };
  const std::string epoch_;
  const std::uint64_t most_per_tenant_;
  mutable Mutex lock_;
  std::map<std::string, Entry> watches_ ALVOR_GUARDED_BY(lock_);
  std::map<std::string, std::weak_ptr<FrameSource>> sources_ ALVOR_GUARDED_BY(lock_);  ///< by the name of the solve
  std::uint64_t frames_ ALVOR_GUARDED_BY(lock_) = 0, bytes_
                                                     ALVOR_GUARDED_BY(lock_) = 0;  ///< sums over the watches that have ended
  bool stopping_ ALVOR_GUARDED_BY(lock_) = false;
  TaskQueue turns_;
};

}  // namespace alvor
