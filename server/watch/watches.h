#pragma once
// All who watch: finds a watch by its id, and gives each its turns.

#include "server/base/mutex.h"
#include "server/base/task_queue.h"
#include "server/watch/watch.h"

#include <map>
#include <memory>
#include <string>

namespace alvor {

/// Thread-safe. All turns are taken on one thread of its own: neither the solver nor gRPC encodes frames.
class Watches {
 public:
  explicit Watches(std::string epoch, std::uint64_t most_per_tenant = Quota{}.watchers)
      : epoch_(std::move(epoch)), most_per_tenant_(most_per_tenant) {}
  const std::string& epoch() const { return epoch_; }

  /// The same source for all who watch `solve` at a time.
  std::shared_ptr<FrameSource> frames_of(const std::shared_ptr<StoredSolve>& solve);

  /// UNAVAILABLE after stop_all; RESOURCE_EXHAUSTED where the tenant has as many as it may.
  void add(const std::string& id, const std::shared_ptr<Watch>& watch, const std::string& tenant = {});
  void remove(const std::string& id);
  /// NOT_FOUND when the watch has ended, or is another tenant's; INVALID_ARGUMENT as in Watch::acknowledge.
  void acknowledge(const std::string& id, std::uint64_t frame_count, std::uint64_t revision, const std::string& tenant = {});
  struct Traffic {
    std::size_t watchers = 0;
    std::uint64_t frames = 0, bytes = 0;  ///< since the server was started
    std::uint64_t most_behind = 0;        ///< revisions that one watcher has not acknowledged
  };
  Traffic traffic() const;
  /// Ends every watch, and lets none begin.
  void stop_all();

  /// Lets the solve's log go where nobody else watches it. Requires: the caller's watch and log have gone already.
  void release(std::shared_ptr<StoredSolve> solve);
  /// Gives a new watch its first turn, which was asked for when it was made.
  void begin(const std::shared_ptr<Watch>& watch);
  /// Quick: may be called from any callback. Two asks before the turn are one turn.
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
  std::map<std::string, std::weak_ptr<FrameSource>> sources_ ALVOR_GUARDED_BY(lock_);     ///< by the name of the solve
  std::uint64_t frames_ ALVOR_GUARDED_BY(lock_) = 0, bytes_ ALVOR_GUARDED_BY(lock_) = 0;  ///< of watches that have ended
  bool stopping_ ALVOR_GUARDED_BY(lock_) = false;
  TaskQueue turns_;
};

}  // namespace alvor
