#pragma once
// How much memory the server may take. It refuses work while there is room to say so, and is not killed for taking too much.

#include <cstdint>
#include <string>

namespace alvor {

/// Of this process, in bytes.
struct ResidentMemory {
  std::uint64_t all = 0;
  std::uint64_t of_files = 0;  ///< the system can take these back
};
ResidentMemory resident_memory();

/// What this process has taken that nothing but memory can hold, in bytes.
std::uint64_t held_bytes();

/// What the control group of this process allows, or else the machine, in bytes.
std::uint64_t allowed_memory();

/// Thread-safe.
class MemoryGuard {
 public:
  MemoryGuard() = default;  ///< no limit
  /// 0: no limit.
  explicit MemoryGuard(std::uint64_t limit, std::uint64_t (*used)() = held_bytes) : limit_(limit), used_(used) {}

  /// RESOURCE_EXHAUSTED, saying that `what` needs it, where more than three quarters would be in use with `bytes` more.
  void admit(const std::string& what, std::uint64_t bytes) const;
  /// Whether admit() would.
  bool has_room(std::uint64_t bytes) const;
  /// More than seven eighths are in use: something must go.
  bool is_short() const;

  std::uint64_t limit() const { return limit_; }

 private:
  std::uint64_t limit_ = 0;
  std::uint64_t (*used_)() = held_bytes;
};

}  // namespace alvor
