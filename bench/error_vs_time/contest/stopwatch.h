#pragma once

#include <chrono>
#include <ctime>

namespace alvor::bench {

/// Measures wall time and the calling thread's CPU time since construction. Work in an arena of one thread runs on the calling
/// thread, so it is counted.
class Stopwatch {
 public:
  double wall_s() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count(); }
  double cpu_s() const { return thread_s() - cpu_begin_s_; }

 private:
  static double thread_s() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
  }

  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  double cpu_begin_s_ = thread_s();
};

}  // namespace alvor::bench
