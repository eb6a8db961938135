#pragma once
// Runs tasks that must not run on gRPC's or the solver's threads.

#include "server/base/mutex.h"

#include <chrono>
#include <functional>
#include <map>
#include <thread>

namespace alvor {

/// One thread that runs tasks when they are due. Tasks due at the same time run in the order of posting. Tasks must not throw.
class TaskQueue {
 public:
  using Clock = std::chrono::steady_clock;

  TaskQueue();
  /// Runs the tasks that are due and drops later ones.
  ~TaskQueue();
  TaskQueue(const TaskQueue&) = delete;
  TaskQueue& operator=(const TaskQueue&) = delete;

  void post(std::function<void()> task) { post_at(Clock::time_point::min(), std::move(task)); }
  void post_at(Clock::time_point due, std::function<void()> task);

 private:
  void run();
  std::function<void()> take_due(Lock& hold) ALVOR_REQUIRES(lock_);

  Mutex lock_;
  Condition changed_;
  std::multimap<Clock::time_point, std::function<void()>> tasks_ ALVOR_GUARDED_BY(lock_);
  bool stopping_ ALVOR_GUARDED_BY(lock_) = false;
  std::thread thread_;
};

}  // namespace alvor
