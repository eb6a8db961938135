#pragma once
// Uploads whose connection was lost, and that may be gone on with.

#include "server/base/mutex.h"
#include "server/base/request_ids.h"
#include "server/scenes/scene_upload.h"

#include <chrono>
#include <map>
#include <memory>
#include <utility>

namespace alvor {

/// How many uploads may wait and how many bytes they may come to, in memory. One tenant alone cannot reach what all may.
struct WaitingLimits {
  std::size_t count = 64, count_of_all = 1024;
  std::uint64_t bytes = std::uint64_t{512} << 20, bytes_of_all = std::uint64_t{1} << 30;
};

/// Thread-safe. Throws StatusError.
class Uploads {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::minutes patience{10};
  static constexpr std::size_t most_open = 16;  ///< of a tenant, at a time

  explicit Uploads(const WaitingLimits& limits = {}) : limits_(limits) {}

  /// An upload begins and ends. RESOURCE_EXHAUSTED where a tenant has too many open.
  void open(const std::string& tenant);
  void close(const std::string& tenant);

  /// Keeps what has arrived. Does nothing for a request without an id. Where the tenant's uploads are then too many or too large,
  /// its oldest go; where those of all are, the oldest of the tenant that has most.
  void put(const Caller& caller, std::unique_ptr<SceneUpload> upload);
  /// How many chunks wait. NOT_FOUND.
  std::uint64_t chunks(const Caller& caller);
  /// Takes it out. NOT_FOUND where none waits, or another number of chunks does.
  std::unique_ptr<SceneUpload> take(const Caller& caller, std::uint64_t chunks);

 private:
  struct Waiting {
    std::unique_ptr<SceneUpload> upload;
    Clock::time_point since;
  };
  using Key = std::pair<std::string, std::string>;
  struct Sum {
    std::size_t count = 0;
    std::uint64_t bytes = 0;
  };
  void drop_expired() ALVOR_REQUIRES(lock_);
  std::map<std::string, Sum> sums() const ALVOR_REQUIRES(lock_);
  void drop_oldest(const std::string& tenant) ALVOR_REQUIRES(lock_);
  void keep_tenant_within_limits(const std::string& tenant) ALVOR_REQUIRES(lock_);
  void keep_all_within_limits() ALVOR_REQUIRES(lock_);
  std::map<Key, Waiting>::iterator find(const Caller& caller) ALVOR_REQUIRES(lock_);

  const WaitingLimits limits_;
  Mutex lock_;
  std::map<Key, Waiting> waiting_ ALVOR_GUARDED_BY(lock_);
  std::map<std::string, std::size_t> open_ ALVOR_GUARDED_BY(lock_);  ///< by tenant
};

}  // namespace alvor
