#pragma once
// The solves that a server holds, and the threads they run on.

#include "server/base/memory_guard.h"
#include "server/base/mutex.h"
#include "server/base/task_queue.h"
#include "server/solves/solve_spec.h"
#include "server/solves/stored_solve.h"

#include <map>
#include <memory>
#include <string>
#include <thread>
#include <vector>

namespace spdlog {
class logger;
}

namespace alvor {

/// A logger that writes nothing.
std::shared_ptr<spdlog::logger> silent_logger();

struct SolveStoreOptions {
  int max_running = 4;     ///< each uses all of the machine unless its spec says less; more of them only share it
  int max_waiting = 1000;  ///< beyond those
  SolveLimits limits;
  Quota quota;
  MemoryGuard memory;
  /// Ends something else that takes memory, if it can; asked before a solve must end. Returns whether it did.
  std::function<bool()> spare_solves = [] { return false; };
  Solver solver = solve_in_process;
  /// Returns the solver of one solve of a scene of so many faces, held until that has ended; or an empty one while there is none,
  /// so that the solve waits until another has ended. Null: `solver` for all.
  std::function<Solver(std::uint64_t faces, const SolveOptions&)> solver_for;
  Keeping keeping;
  std::chrono::steady_clock::duration patience =
      std::chrono::seconds(7);                               ///< with solves that are to be parked when the server stops
  std::shared_ptr<spdlog::logger> logger = silent_logger();  ///< never null
};

/// Thread-safe. Throws StatusError. Solves of other tenants than the caller are NOT_FOUND.
class SolveStore {
 public:
  /// Begins with the solves of the archive, if there is one; those that have not ended go on. `scenes` is only used here.
  SolveStore(SolveStoreOptions options, const SceneStore& scenes);
  /// As shut_down().
  ~SolveStore();

  /// Starts at once on a thread of its own, or waits. RESOURCE_EXHAUSTED when too many wait or memory is short, INVALID_ARGUMENT
  /// names the field of the spec. The same request again gets the same solve. When it returns the solve is kept.
  std::shared_ptr<StoredSolve> create(SceneUse scene, const SolveSpec& spec, const Caller& caller = {});
  /// NOT_FOUND.
  std::shared_ptr<StoredSolve> find(const std::string& name, const std::string& tenant = {}) const;
  /// Of one scene, or of all when `scene_name` is "scenes/-".
  Page<const StoredSolve> list(const std::string& scene_name, const PageRequest& request, const std::string& tenant = {}) const;
  /// Asks it to stop and returns at once; one that has ended is left as it is. NOT_FOUND.
  std::shared_ptr<StoredSolve> cancel(const std::string& name, const std::string& tenant = {});
  /// NOT_FOUND; FAILED_PRECONDITION when it has ended.
  std::shared_ptr<StoredSolve> pause(const std::string& name, const std::string& tenant = {});
  std::shared_ptr<StoredSolve> resume(const std::string& name, const std::string& tenant = {});
  /// Edits the scene of a solve, see StoredSolve::edit(), and returns the revision of the step. NOT_FOUND; RESOURCE_EXHAUSTED as
  /// for create(), where the solve had ended.
  std::uint64_t edit(const std::string& name, const EditRequest& request, const std::string& tenant = {});
  /// NOT_FOUND; FAILED_PRECONDITION before it has ended. Those who hold the solve may go on reading it.
  void remove(const std::string& name, const std::string& tenant = {});
  /// Nothing runs when it returns, and later creates are UNAVAILABLE. With an archive, what runs is parked, to go on when the
  /// server is started again; else it is cancelled.
  void shut_down();

  /// Every solve, for metrics.
  std::vector<std::shared_ptr<StoredSolve>> all() const;

 private:
  struct Entry {
    SceneUse scene;
    std::shared_ptr<StoredSolve> solve;
    std::stop_source cancel, park, short_of_memory;
    bool is_running = false;
    std::string refusal;  ///< why its spec is beyond the limits of this server; empty if it is not
    int editors = 0;      ///< calls that are editing it: it is not removed
    bool shall_pause = false, shall_cancel = false;
  };
  Entry& entry(const std::string& name, const std::string& tenant) ALVOR_REQUIRES(lock_);
  const Entry& entry(const std::string& name, const std::string& tenant) const ALVOR_REQUIRES(lock_) {
    return const_cast<SolveStore&>(*this).entry(name, tenant);
  }
  void restore(Archive& archive, const SceneStore& scenes);
  void restore(Archive::SolveRow row, const SceneStore& scenes) ALVOR_REQUIRES(lock_);
  std::shared_ptr<StoredSolve> repeated(const Caller& caller, const std::string& scene, const SolveSpec& spec)
      ALVOR_REQUIRES(lock_);
  void check_capacity(const std::string& tenant, const SolveOptions& next, bool is_new) ALVOR_REQUIRES(lock_);
  void note_live(const std::shared_ptr<StoredSolve>& solve) ALVOR_REQUIRES(lock_);
  void drop_old_live();
  void start_waiting() ALVOR_REQUIRES(lock_);
  void watch_memory();
  void relieve_memory();
  std::string hungriest_tenant() const ALVOR_REQUIRES(lock_);
  void drop_logs();
  Entry* next_waiting() ALVOR_REQUIRES(lock_);
  Solver solver_for(const Entry& entry) const;
  void start(Entry& entry, Solver solver) ALVOR_REQUIRES(lock_);
  void run(Entry& entry, Solver solver);
  void settle(const Entry& entry) ALVOR_REQUIRES(lock_);
  void join_finished() ALVOR_REQUIRES(lock_);

  const SolveStoreOptions options_;
  mutable Mutex lock_;
  Condition changed_;
  std::map<std::string, Entry> solves_ ALVOR_GUARDED_BY(lock_);  ///< entries of running solves are not removed
  RequestIds requests_ ALVOR_GUARDED_BY(lock_);
  std::uint64_t next_number_ ALVOR_GUARDED_BY(lock_) = 1;
  int running_ ALVOR_GUARDED_BY(lock_) = 0;
  bool stopping_ ALVOR_GUARDED_BY(lock_) = false;
  std::stop_source abandon_;
  std::map<std::thread::id, std::thread> threads_ ALVOR_GUARDED_BY(lock_);
  /// A solve that may be kept live, and when it ended.
  struct Ended {
    std::weak_ptr<StoredSolve> solve;
    std::chrono::steady_clock::time_point at;
  };
  std::vector<Ended> live_ ALVOR_GUARDED_BY(lock_);                ///< those that ended last, oldest first
  std::vector<std::thread::id> finished_ ALVOR_GUARDED_BY(lock_);  ///< have nothing left to do but to end
  std::shared_ptr<void> relief_;                                   ///< registered with the memory guard
  std::unique_ptr<TaskQueue> watching_memory_;                     ///< uses all of the above; null without a limit
};

}  // namespace alvor
