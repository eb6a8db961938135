#pragma once
// The processor time of this process.

#include <ctime>

namespace alvor {

/// Returns the processor time that all threads of this process have taken, in seconds.
inline double cpu_seconds() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace alvor
