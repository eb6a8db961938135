#pragma once
// Keeps uploads whose connection was lost, so that they can be resumed.

#include "server/base/mutex.h"
#include "server/base/request_ids.h"
#include "server/scenes/file_upload.h"
#include "server/scenes/scene_upload.h"

#include <chrono>
#include <map>
#include <memory>
#include <utility>

namespace alvor {

/// Limits of the uploads that wait to be resumed, which are held in memory: for one tenant, and for all. A single tenant cannot
/// reach the limits for all.
struct WaitingLimits {
  std::size_t count = 64, count_of_all = 1024;
  std::uint64_t bytes = std::uint64_t{512} << 20, bytes_of_all = std::uint64_t{1} << 30;
};

/// The uploads that wait to be resumed. Thread-safe. Throws StatusError.
class Uploads {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::minutes patience{10};  ///< how long an upload waits to be resumed
  static constexpr std::size_t most_open = 16;         ///< open uploads of one tenant

  explicit Uploads(const WaitingLimits& limits = {}) : limits_(limits) {}

  /// Counts an upload that begins. Throws RESOURCE_EXHAUSTED if the tenant has too many open.
  void open(const std::string& tenant);
  /// Counts an upload that has ended.
  void close(const std::string& tenant);

  /// Keeps an unfinished upload. Does nothing for a request without an id. If the tenant then exceeds its limits, its oldest
  /// uploads are dropped; if all tenants together exceed theirs, the oldest of the tenant that has most.
  void put(const Caller& caller, std::unique_ptr<ResumableUpload> upload);
  /// Returns how much of the caller's upload has arrived. Throws NOT_FOUND.
  v1::Upload describe(const Caller& caller);
  /// Removes and returns the caller's upload. Throws NOT_FOUND if none waits, or if another number of chunks has arrived.
  std::unique_ptr<SceneUpload> take(const Caller& caller, std::uint64_t chunks);
  /// Removes and returns the caller's upload of files, or null if none waits.
  std::unique_ptr<FileUpload> take_files(const Caller& caller);
  /// Drops all, to free memory. Their callers send them again.
  void clear();

 private:
  struct Waiting {
    std::unique_ptr<ResumableUpload> upload;
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
  template <class Upload>
  std::unique_ptr<Upload> release(std::map<Key, Waiting>::iterator found) ALVOR_REQUIRES(lock_);

  const WaitingLimits limits_;
  Mutex lock_;
  std::map<Key, Waiting> waiting_ ALVOR_GUARDED_BY(lock_);
  std::map<std::string, std::size_t> open_ ALVOR_GUARDED_BY(lock_);  ///< by tenant
};

}  // namespace alvor
