#pragma once
// The solves that a server holds, in memory, and the threads they run on.

#include "server/solve_spec.h"
#include "server/stored_solve.h"

#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace spdlog {
class logger;
}

namespace alvor {

struct SolveStoreOptions {
  int max_running = 4;  ///< each uses all of the machine unless its spec says less; more of them only share it
  SolveLimits limits;
  Solver solver = solve_as_planned;
  std::shared_ptr<spdlog::logger> logger;  ///< never null
};

/// Thread-safe. Throws StatusError.
class SolveStore {
 public:
  explicit SolveStore(SolveStoreOptions options);
  /// Stops and joins all solves.
  ~SolveStore();

  /// Starts at once on a thread of its own. RESOURCE_EXHAUSTED when too many run, INVALID_ARGUMENT names the field of the spec.
  std::shared_ptr<StoredSolve> create(SceneUse scene, const v1::SolveSpec& spec);
  /// NOT_FOUND.
  std::shared_ptr<StoredSolve> find(const std::string& name) const;
  /// Of one scene, or of all when `scene_name` is "scenes/-".
  Page<const StoredSolve> list(const std::string& scene_name, const PageRequest& request) const;
  /// Asks it to stop and returns at once; one that has ended is left as it is. NOT_FOUND.
  std::shared_ptr<StoredSolve> cancel(const std::string& name);
  /// NOT_FOUND; FAILED_PRECONDITION while it is running. Those who hold the solve may go on reading it.
  void remove(const std::string& name);
  /// Cancels all solves and waits for them; later creates are UNAVAILABLE.
  void shut_down();

 private:
  /// The thread is joined when the entry goes.
  struct Entry {
    SceneUse scene;
    std::shared_ptr<StoredSolve> solve;
    std::jthread thread;
  };
  Entry& entry(const std::string& name);
  const Entry& entry(const std::string& name) const { return const_cast<SolveStore&>(*this).entry(name); }
  void check_capacity() const;
  std::jthread start(const std::shared_ptr<StoredSolve>& solve) const;

  const SolveStoreOptions options_;
  mutable std::mutex lock_;
  std::map<std::string, Entry> solves_;
  std::uint64_t next_number_ = 1;
  bool stopping_ = false;
};

}  // namespace alvor
