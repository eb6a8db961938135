#pragma once
// The threads that do the work of calls.

#include "server/base/task_queue.h"
#include "server/base/work_pool.h"

namespace alvor {

/// Pools of threads for calls, one for each kind of work.
struct CallPools {
  /// For building and loading scenes.
  WorkPool building{{.threads = 4, .of_one = 2, .time = std::chrono::minutes(1)}};
  /// For having files read, each by a process of its own, which takes memory.
  WorkPool importing{{.threads = 2, .of_one = 1, .time = std::chrono::minutes(20)}};
  /// For all other work that may wait for a lock or the disk.
  WorkPool keeping{{.threads = 8, .of_one = 4}};
  /// For starting watches, which may have to load a solution.
  WorkPool watching{{.threads = 4, .of_one = 2}};
  TaskQueue timers;
};

}  // namespace alvor
