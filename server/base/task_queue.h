#pragma once
// Work that must not run on gRPC's or the solver's threads.

#include <chrono>
#include <condition_variable>
#include <functional>
#include <map>
#include <mutex>
#include <thread>

namespace alvor {

/// One thread that runs tasks when they are due, those due at the same time in order of posting. Tasks must not throw.
class TaskQueue {
 public:
  using Clock = std::chrono::steady_clock;

  TaskQueue();
  /// Runs what is due, drops what is due later.
  ~TaskQueue();
  TaskQueue(const TaskQueue&) = delete;
  TaskQueue& operator=(const TaskQueue&) = delete;

  void post(std::function<void()> task) { post_at(Clock::time_point::min(), std::move(task)); }
  void post_at(Clock::time_point due, std::function<void()> task);

 private:
  void run();
  std::function<void()> take_due(std::unique_lock<std::mutex>& hold);

  std::mutex lock_;
  std::condition_variable changed_;
  std::multimap<Clock::time_point, std::function<void()>> tasks_;
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace alvor
