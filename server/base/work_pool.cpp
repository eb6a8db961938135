#include "server/base/work_pool.h"

#include "server/base/status_error.h"

namespace alvor {

namespace {

constexpr auto between_looks = std::chrono::seconds(1);
const grpc::Status stopping{grpc::UNAVAILABLE, "the server is stopping"};

}  // namespace

void CallStop::stop(const grpc::Status& why) {
  {
    Lock hold(lock_);
    if (why_.ok()) why_ = why;
  }
  source_.request_stop();
}

void CallStop::refuse_stopped() const {
  if (const grpc::Status why = reason(); !why.ok()) throw StatusError(why.error_code(), why.error_message());
}

grpc::Status CallStop::reason() const {
  Lock hold(lock_);
  return why_;
}

WorkPool::WorkPool(const WorkLimits& limits) : limits_(limits) {
  for (int n = 0; n < limits.threads; ++n) threads_.emplace_back([this] { run(); });
  watch_.post([this] { watch_time(); });
}

WorkPool::~WorkPool() {
  stop();
  {
    Lock hold(lock_);
    is_ending_ = true;
  }
  changed_.notify_all();
}

void WorkPool::post(const std::string& caller, std::shared_ptr<CallStop> stop, std::function<void()> task) {
  {
    Lock hold(lock_);
    Queue& queue = queues_[caller];
    if (queue.waiting.size() >= limits_.waiting)
      throw StatusError(grpc::RESOURCE_EXHAUSTED,
                        "calls: " + std::to_string(limits_.waiting) + " wait already, as many as are allowed");
    if (is_stopped_) stop->stop(stopping);
    queue.waiting.push_back({std::move(stop), std::move(task), {}});
  }
  changed_.notify_one();
}

void WorkPool::stop() {
  Lock hold(lock_);
  is_stopped_ = true;
  for (const auto& [caller, queue] : queues_)
    for (const Task& task : queue.waiting) task.stop->stop(stopping);
  for (const Task* task : running_) task->stop->stop(stopping);
}

void WorkPool::run() {
  Lock hold(lock_);
  for (;;) {
    auto next = queues_.end();
    changed_.wait(
        hold, [&]() ALVOR_REQUIRES(lock_) { return (next = next_queue()) != queues_.end() || (is_ending_ && queues_.empty()); });
    if (next == queues_.end()) return;
    Task task = std::move(next->second.waiting.front());
    next->second.waiting.pop_front();
    ++next->second.running;
    last_ = next->first;
    task.begun = Clock::now();
    running_.push_back(&task);
    hold.unlock();
    task.work();
    task.work = nullptr;  // may free much memory, so not under the lock
    hold.lock();
    std::erase(running_, &task);
    if (--next->second.running == 0 && next->second.waiting.empty()) queues_.erase(next);
    changed_.notify_all();
  }
}

/// Returns the queue of the next caller in turn (in a circle, after the last one) that has a task waiting and a thread left.
WorkPool::Queues::iterator WorkPool::next_queue() {
  auto queue = queues_.upper_bound(last_);
  for (std::size_t n = 0; n < queues_.size(); ++n, ++queue) {
    if (queue == queues_.end()) queue = queues_.begin();
    if (!queue->second.waiting.empty() && queue->second.running < limits_.of_one) return queue;
  }
  return queues_.end();
}

void WorkPool::watch_time() {
  const auto now = Clock::now();
  {
    Lock hold(lock_);
    const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(limits_.time).count();
    for (const Task* task : running_)
      if (now >= task->begun + limits_.time)
        task->stop->stop(
            {grpc::RESOURCE_EXHAUSTED, "takes longer than " + std::to_string(seconds) + " s, the limit of this server"});
  }
  watch_.post_at(now + between_looks, [this] { watch_time(); });
}

}  // namespace alvor
