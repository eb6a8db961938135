#pragma once
// Measures the CPU time of one solve among others in the process.

#include <tbb/task_arena.h>
#include <tbb/task_scheduler_observer.h>

#include <map>
#include <mutex>
#include <thread>

#include <ctime>

namespace alvor {

/// Adds up the CPU time of threads while they are in an arena. Requires: constructed before any thread enters the arena.
class CpuClock : public tbb::task_scheduler_observer {
 public:
  explicit CpuClock(tbb::task_arena& arena);
  ~CpuClock() override;
  CpuClock(const CpuClock&) = delete;
  CpuClock& operator=(const CpuClock&) = delete;

  /// Returns the CPU seconds of all threads so far, including those that are still in the arena. Safe from any thread.
  double seconds() const;

  void on_scheduler_entry(bool is_worker) override;
  void on_scheduler_exit(bool is_worker) override;

 private:
  /// A thread that is in the arena: its CPU clock, and the clock's time when it entered.
  struct Visit {
    clockid_t clock;
    double since_s;
  };
  mutable std::mutex mutex_;
  std::map<std::thread::id, Visit> inside_;
  double left_s_ = 0;  ///< CPU seconds of threads' visits that ended
};

}  // namespace alvor
