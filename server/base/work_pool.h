#pragma once
// Threads for calls that take long or wait for the disk; such work must not run on gRPC's threads.

#include "server/base/mutex.h"
#include "server/base/task_queue.h"

#include <grpcpp/support/status.h>

#include <chrono>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

namespace alvor {

/// Asks the work of one call to end, with a reason. Thread-safe.
class CallStop {
 public:
  /// Asks to stop. Only the first reason counts.
  void stop(const grpc::Status& why);
  std::stop_token token() const { return source_.get_token(); }
  /// Throws StatusError with the reason if a stop was asked for.
  void refuse_stopped() const;
  /// Returns the reason, or OK if no stop was asked for.
  grpc::Status reason() const;

 private:
  std::stop_source source_;
  mutable Mutex lock_;
  grpc::Status why_ ALVOR_GUARDED_BY(lock_);
};

/// Limits of a WorkPool.
struct WorkLimits {
  std::size_t waiting = 1000;  ///< waiting tasks of one caller
  int threads = 4;
  int of_one = 2;                                                   ///< threads that work for one caller at a time
  std::chrono::steady_clock::duration time{std::chrono::hours(1)};  ///< most time for a task; then RESOURCE_EXHAUSTED
};

/// A pool of threads that callers share in turns. The tasks of one caller begin in the order of posting. Every task runs once,
/// even if it is stopped before it begins. Tasks must not throw. Thread-safe.
class WorkPool {
 public:
  explicit WorkPool(const WorkLimits& limits);
  /// Calls stop() and waits for all tasks.
  ~WorkPool();
  WorkPool(const WorkPool&) = delete;
  WorkPool& operator=(const WorkPool&) = delete;

  /// Queues a task. `caller` identifies the caller. Throws StatusError RESOURCE_EXHAUSTED if too many of its tasks wait.
  void post(const std::string& caller, std::shared_ptr<CallStop> stop, std::function<void()> task);
  /// Stops all tasks, also later ones, with UNAVAILABLE.
  void stop();

 private:
  using Clock = std::chrono::steady_clock;
  struct Task {
    std::shared_ptr<CallStop> stop;
    std::function<void()> work;
    Clock::time_point begun;
  };
  struct Queue {
    std::deque<Task> waiting;
    int running = 0;
  };
  using Queues = std::map<std::string, Queue>;

  void run();
  Queues::iterator next_queue() ALVOR_REQUIRES(lock_);
  void watch_time();

  const WorkLimits limits_;
  Mutex lock_;
  Condition changed_;
  Queues queues_ ALVOR_GUARDED_BY(lock_);     ///< by caller; only those with tasks
  std::string last_ ALVOR_GUARDED_BY(lock_);  ///< the caller whose task began last
  std::vector<const Task*> running_ ALVOR_GUARDED_BY(lock_);
  bool is_stopped_ ALVOR_GUARDED_BY(lock_) = false, is_ending_ ALVOR_GUARDED_BY(lock_) = false;
  std::vector<std::jthread> threads_;
  TaskQueue watch_;  ///< uses all members above
};

}  // namespace alvor
