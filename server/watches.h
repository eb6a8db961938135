#pragma once
// All who watch: finds a watch by its id, and gives each its turns.

#include "server/task_queue.h"
#include "server/watch.h"

#include <map>
#include <memory>
#include <mutex>
#include <string>

namespace alvor {

/// Thread-safe. All turns are taken on one thread of its own: neither the solver nor gRPC encodes frames.
class Watches {
 public:
  explicit Watches(std::string epoch) : epoch_(std::move(epoch)) {}
  const std::string& epoch() const { return epoch_; }

  /// The same source for all who watch `solve` at a time.
  std::shared_ptr<FrameSource> frames_of(const std::shared_ptr<StoredSolve>& solve);

  /// UNAVAILABLE after stop_all.
  void add(const std::string& id, const std::shared_ptr<Watch>& watch);
  void remove(const std::string& id);
  /// NOT_FOUND when the watch has ended; INVALID_ARGUMENT as in Watch::acknowledge.
  void acknowledge(const std::string& id, std::uint64_t frame_count, std::uint64_t revision);
  /// Ends every watch, and lets none begin.
  void stop_all();

  /// Quick: may be called from any callback. Two asks before the turn are one turn.
  void ask_for_turn(const std::shared_ptr<Watch>& watch);

 private:
  void take_turn(const std::shared_ptr<Watch>& watch);

  const std::string epoch_;
  std::mutex lock_;
  std::map<std::string, std::shared_ptr<Watch>> watches_;
  std::map<std::string, std::weak_ptr<FrameSource>> sources_;  ///< by the name of the solve
  bool stopping_ = false;
  TaskQueue turns_;
};

}  // namespace alvor
