#include "server/base/task_queue.h"

namespace alvor {

TaskQueue::TaskQueue() : thread_([this] { run(); }) {}

TaskQueue::~TaskQueue() {
  {
    Lock hold(lock_);
    stopping_ = true;
  }
  changed_.notify_one();
  thread_.join();
}

void TaskQueue::post_at(Clock::time_point due, std::function<void()> task) {
  {
    Lock hold(lock_);
    tasks_.emplace(due, std::move(task));
  }
  changed_.notify_one();
}

void TaskQueue::run() {
  Lock hold(lock_);
  while (auto task = take_due(hold)) {
    hold.unlock();
    task();
    task = nullptr;  // may free much memory, so not under the lock
    hold.lock();
  }
}

// Waits for the next task and returns it; returns an empty function when the queue is stopping and no task is due.
std::function<void()> TaskQueue::take_due(Lock& hold) {
  for (;;) {
    const auto first = tasks_.begin();
    if (first != tasks_.end() && first->first <= Clock::now()) return std::move(tasks_.extract(first).mapped());
    if (stopping_) return {};
    if (first == tasks_.end()) {
      changed_.wait(hold);
    } else {
      const auto due = first->first;  // copied, as the entry may be gone when the wait ends
      changed_.wait_until(hold, due);
    }
  }
}

}  // namespace alvor
