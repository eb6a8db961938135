#pragma once
// CPU time of one solve, whatever else the process does.

#include <tbb/task_arena.h>
#include <tbb/task_scheduler_observer.h>

#include <map>
#include <mutex>
#include <thread>

#include <ctime>

namespace alvor {

/// Counts the time of the threads while they are in an arena. Construct it before they enter.
class CpuClock : public tbb::task_scheduler_observer {
 public:
  explicit CpuClock(tbb::task_arena& arena);
  ~CpuClock() override;
  CpuClock(const CpuClock&) = delete;
  CpuClock& operator=(const CpuClock&) = delete;

  /// Of all threads so far, those that are still in included. Safe from any thread.
  double seconds() const;

  void on_scheduler_entry(bool is_worker) override;
  void on_scheduler_exit(bool is_worker) override;

 private:
  struct Visit {
    clockid_t clock;
    double since_s;
  };
  mutable std::mutex mutex_;
  std::map<std::thread::id, Visit> inside_;
  double left_s_ = 0;  ///< of the visits that ended
};

}  // namespace alvor
