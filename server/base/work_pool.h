#pragma once
// Threads for calls whose work takes long or waits for the disk: none of it may run on gRPC's threads.

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

/// Tells the work of one call that it shall end, and why. Thread-safe.
class CallStop {
 public:
  /// The first reason counts.
  void stop(const grpc::Status& why);
  std::stop_token token() const { return source_.get_token(); }
  /// Throws StatusError with the reason, if there is one.
  void refuse_stopped() const;
  /// OK where it was not stopped.
  grpc::Status reason() const;

 private:
  std::stop_source source_;
  mutable Mutex lock_;
  grpc::Status why_ ALVOR_GUARDED_BY(lock_);
};

struct WorkLimits {
  std::size_t waiting = 1000;  ///< tasks of one caller
  int threads = 4;
  int of_one = 2;                                                   ///< threads that the work of one caller takes at most
  std::chrono::steady_clock::duration time{std::chrono::hours(1)};  ///< of one task; then it is RESOURCE_EXHAUSTED
};

/// Callers take turns; the tasks of one caller begin in the order in which they were posted. Every task is run, once, even if it
/// is to stop before it has begun. Tasks must not throw. Thread-safe.
class WorkPool {
 public:
  explicit WorkPool(const WorkLimits& limits);
  /// As stop(); waits for all tasks.
  ~WorkPool();
  WorkPool(const WorkPool&) = delete;
  WorkPool& operator=(const WorkPool&) = delete;

  /// `caller` is a name that other callers do not have. Throws StatusError where too many of its tasks wait: RESOURCE_EXHAUSTED.
  void post(const std::string& caller, std::shared_ptr<CallStop> stop, std::function<void()> task);
  /// Stops all tasks, those to come too: UNAVAILABLE.
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
  TaskQueue watch_;  ///< uses all of the above
};

}  // namespace alvor
