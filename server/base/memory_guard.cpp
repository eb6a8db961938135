#include "server/base/memory_guard.h"

#include "server/base/mutex.h"
#include "server/base/status_error.h"
#include "server/base/task_queue.h"

#include <malloc.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <fstream>
#include <limits>
#include <map>
#include <sstream>

namespace alvor {

namespace {

constexpr auto unlimited = std::numeric_limits<std::uint64_t>::max();
constexpr std::uint64_t least_free = 64 << 20;  // for a solve that is ending, which was seen to take 52 MB more

std::uint64_t page_size() { return static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE)); }

/// Returns the limit in a file of the control group; unlimited for "max" and for what cannot be read.
std::uint64_t limit_in(const std::string& file) {
  std::uint64_t bytes = 0;
  return std::ifstream(file) >> bytes && bytes > 0 ? bytes : unlimited;
}

/// Returns the smallest memory limit of the process's control groups. In a container its own group is the root of the tree it
/// sees.
std::uint64_t limit_of_group() {
  std::uint64_t least = unlimited;
  std::ifstream groups("/proc/self/cgroup");  // lines ID:CONTROLLERS:PATH
  for (std::string line; std::getline(groups, line);) {
    std::istringstream fields(line);
    std::string id, controllers, path;
    std::getline(std::getline(std::getline(fields, id, ':'), controllers, ':'), path);
    const bool is_v2 = controllers.empty();
    if (!is_v2 && controllers.find("memory") == std::string::npos) continue;
    const std::string root = is_v2 ? "/sys/fs/cgroup" : "/sys/fs/cgroup/memory";
    const std::string file = is_v2 ? "/memory.max" : "/memory.limit_in_bytes";
    least = std::min({least, limit_in(root + file), limit_in(root + path + file)});
  }
  return least;
}

std::string megabytes(std::uint64_t bytes) { return std::to_string(bytes >> 20) + " MiB"; }

/// Trims the heap at most twice a second: for a heap of gigabytes trimming takes a tenth of a second.
class HeapTrimmer {
 public:
  void ask() {
    if (is_asked_.exchange(true)) return;
    tasks_.post_at(TaskQueue::Clock::now() + std::chrono::milliseconds(500), [this] {
      is_asked_ = false;
      malloc_trim(0);
    });
  }

 private:
  std::atomic<bool> is_asked_ = false;
  TaskQueue tasks_;
};

}  // namespace

void trim_heap_soon() {
  static HeapTrimmer trimmer;
  trimmer.ask();
}

std::uint64_t resident_bytes() {
  std::uint64_t address_space = 0, resident = 0;  // in pages
  std::ifstream("/proc/self/statm") >> address_space >> resident;
  return resident * page_size();
}

std::uint64_t allowed_memory() {
  const std::uint64_t machine = static_cast<std::uint64_t>(sysconf(_SC_PHYS_PAGES)) * page_size();
  return std::min(machine, limit_of_group());
}

struct MemoryGuard::Relief {
  using Clock = std::chrono::steady_clock;
  // After a relief none is made for this many times the time that it took: trimming a heap of gigabytes takes a tenth of a
  // second. A longer pause would refuse work for which what was freed meanwhile has room.
  static constexpr int pause = 4;
  // Least time after a relief until one is made that no work waits for.
  static constexpr std::chrono::seconds pause_without_work{1};

  std::shared_ptr<void> add(std::function<void()> way) {
    Lock hold(lock);
    const std::uint64_t number = next++;
    ways.emplace(number, std::move(way));
    return {this, [this, number](void*) {
              Lock hold_again(lock);
              ways.erase(number);
            }};
  }
  void give_back(bool work_waits) {
    if (!lock.try_lock()) return;  // not held if another thread is doing it
    const Lock hold(lock, std::adopt_lock);
    const auto start = Clock::now();
    const auto pause_ends = work_waits ? next_time : std::max(next_time, end + pause_without_work);
    if (!is_gain_expected.exchange(false) && start < pause_ends) return;
    for (const auto& [number, way] : ways) way();
    malloc_trim(0);  // memory limits count what the allocator keeps
    end = Clock::now();
    next_time = end + pause * (end - start);
  }

  std::atomic<bool> is_gain_expected = false;
  Mutex lock;
  std::map<std::uint64_t, std::function<void()>> ways ALVOR_GUARDED_BY(lock);
  std::uint64_t next ALVOR_GUARDED_BY(lock) = 0;
  Clock::time_point end ALVOR_GUARDED_BY(lock), next_time ALVOR_GUARDED_BY(lock);  // of the last relief; of the next one
};

MemoryGuard::MemoryGuard(std::uint64_t limit, std::uint64_t (*used)())
    : limit_(limit), used_(used), relief_(std::make_shared<Relief>()) {}

std::uint64_t MemoryGuard::most_of_all() const { return limit_ - std::clamp(least_free, limit_ / 8, limit_ / 4); }

std::uint64_t MemoryGuard::most_for_new_work() const { return most_of_all() / 7 * 6; }

bool MemoryGuard::has_room(std::uint64_t bytes) const {
  if (limit_ == 0) return true;
  const std::uint64_t used = used_(), most = most_for_new_work();
  return used <= most && bytes <= most - used;
}

void MemoryGuard::admit(const std::string& what, std::uint64_t bytes) const {
  make_room(bytes);
  refuse_without_room(what, bytes);
}

void MemoryGuard::refuse_without_room(const std::string& what, std::uint64_t bytes) const {
  if (has_room(bytes)) return;
  throw StatusError(grpc::RESOURCE_EXHAUSTED, what + ": needs about " + megabytes(bytes) + " of memory; " + megabytes(used_()) +
                                                  " of " + megabytes(limit_) + " are in use");
}

void MemoryGuard::make_room(std::uint64_t bytes) const {
  if (!has_room(bytes)) relief_->give_back(true);
}

bool MemoryGuard::runs_short() const {
  if (!has_room(0)) relief_->give_back(false);
  if (!is_short()) return false;
  relief_->give_back(true);
  return is_short();
}

std::shared_ptr<void> MemoryGuard::relieve_by(std::function<void()> give_back) const {
  return relief_->add(std::move(give_back));
}

void MemoryGuard::expect_gain() const { relief_->is_gain_expected = true; }

bool MemoryGuard::is_short() const { return limit_ > 0 && used_() > most_of_all(); }

}  // namespace alvor
