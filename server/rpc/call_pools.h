#pragma once
// Threads for what calls do.

#include "server/base/task_queue.h"
#include "server/base/work_pool.h"

namespace alvor {

struct CallPools {
  /// Building and loading scenes.
  WorkPool building{{.threads = 4, .of_one = 2, .time = std::chrono::minutes(1)}};
  /// Everything else that may wait for a lock or the disk.
  WorkPool keeping{{.threads = 8, .of_one = 4}};
  /// Beginning to watch, for which a solution may have to be loaded.
  WorkPool watching{{.threads = 4, .of_one = 2}};
  TaskQueue timers;
};

}  // namespace alvor
