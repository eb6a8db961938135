#pragma once

#include "server/base/mutex.h"
#include "server/base/task_queue.h"

#include <atomic>
#include <functional>
#include <memory>
#include <utility>

namespace alvor {

/// Calls `tell` when no message came for as long as `patience`. end() must be called before the receiver of `tell` is destroyed.
class IdleWatch : public std::enable_shared_from_this<IdleWatch> {
 public:
  using Clock = TaskQueue::Clock;
  IdleWatch(TaskQueue& tasks, Clock::duration patience, std::function<void()> tell)
      : tasks_(tasks), patience_(patience), tell_(std::move(tell)) {}
  void wait() {
    tasks_.post_at(last_.load() + patience_, [self = shared_from_this()] { self->look(); });
  }
  void note_message() { last_ = Clock::now(); }
  /// Stops: `tell` is not called from now on.
  void end() {
    Lock hold(lock_);
    tell_ = nullptr;
  }

 private:
  void look() {
    Lock hold(lock_);
    if (!tell_) return;
    if (Clock::now() < last_.load() + patience_) wait();
    else tell_();
  }

  TaskQueue& tasks_;
  const Clock::duration patience_;
  Mutex lock_;
  std::function<void()> tell_ ALVOR_GUARDED_BY(lock_);
  std::atomic<Clock::time_point> last_ = Clock::now();
};

}  // namespace alvor
