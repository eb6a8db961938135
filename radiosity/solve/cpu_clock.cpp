#include "radiosity/solve/cpu_clock.h"

#include <pthread.h>

namespace alvor {

namespace {

double read(clockid_t clock) {
  timespec t{};
  clock_gettime(clock, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

}  // namespace

CpuClock::CpuClock(tbb::task_arena& arena) : tbb::task_scheduler_observer(arena) { observe(true); }
CpuClock::~CpuClock() { observe(false); }

void CpuClock::on_scheduler_entry(bool) {
  clockid_t clock = CLOCK_THREAD_CPUTIME_ID;
  pthread_getcpuclockid(pthread_self(), &clock);
  const std::lock_guard lock(mutex_);
  inside_[std::this_thread::get_id()] = {clock, read(clock)};
}

void CpuClock::on_scheduler_exit(bool) {
  const std::lock_guard lock(mutex_);
  const auto visit = inside_.find(std::this_thread::get_id());
  if (visit == inside_.end()) return;
  left_s_ += read(visit->second.clock) - visit->second.since_s;
  inside_.erase(visit);
}

double CpuClock::seconds() const {
  const std::lock_guard lock(mutex_);
  double total = left_s_;
  for (const auto& [thread, visit] : inside_) total += read(visit.clock) - visit.since_s;
  return total;
}

}  // namespace alvor
