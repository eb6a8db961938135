#pragma once
// Uploads whose connection was lost, and that may be gone on with.

#include "server/request_ids.h"
#include "server/scene_upload.h"

#include <chrono>
#include <map>
#include <memory>
#include <mutex>
#include <utility>

namespace alvor {

/// Thread-safe. Throws StatusError.
class Uploads {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::minutes patience{10};
  static constexpr std::size_t most_open = 16;  ///< of a tenant, at a time
  static constexpr std::size_t most_waiting = 64;
  static constexpr std::uint64_t most_bytes = std::uint64_t{1} << 30;  ///< of all tenants: they take memory

  /// An upload begins and ends. RESOURCE_EXHAUSTED where a tenant has too many open.
  void open(const std::string& tenant);
  void close(const std::string& tenant);

  /// Keeps what has arrived. Does nothing for a request without an id. The oldest go when they are too many or too large.
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
  void drop_expired();
  std::map<Key, Waiting>::iterator find(const Caller& caller);

  std::mutex lock_;
  std::map<Key, Waiting> waiting_;
  std::map<std::string, std::size_t> open_;  ///< by tenant
};

}  // namespace alvor
