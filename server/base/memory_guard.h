#pragma once
// How much memory the server may take. It refuses work while there is room to say so, and is not killed for taking too much.

#include <cstdint>
#include <functional>
#include <memory>
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

/// Gives memory that was freed back to the system within a second, on a thread of its own: a limit counts what the allocator
/// keeps. To be called after much was freed.
void trim_heap_soon();

/// What the control group of this process allows, or else the machine, in bytes.
std::uint64_t allowed_memory();

/// Copies share the ways of relief. Thread-safe.
class MemoryGuard {
 public:
  MemoryGuard() : MemoryGuard(0) {}  ///< no limit
  /// 0: no limit.
  explicit MemoryGuard(std::uint64_t limit, std::uint64_t (*used)() = held_bytes);

  /// As make_room(), then as refuse_without_room().
  void admit(const std::string& what, std::uint64_t bytes) const;
  /// Calls the ways of relief if `bytes` more would not fit. The caller must not hold a lock that one of them takes.
  void make_room(std::uint64_t bytes) const;
  /// RESOURCE_EXHAUSTED, saying that `what` needs it, where more than three quarters would be in use with `bytes` more.
  void refuse_without_room(const std::string& what, std::uint64_t bytes) const;
  bool has_room(std::uint64_t bytes) const;
  /// More than seven eighths are in use: something must go.
  bool is_short() const;

  std::uint64_t limit() const { return limit_; }

  /// A way to give back memory that nobody needs, until the returned handle goes.
  std::shared_ptr<void> relieve_by(std::function<void()> give_back) const;

 private:
  struct Relief;

  std::uint64_t limit_;
  std::uint64_t (*used_)();
  std::shared_ptr<Relief> relief_;
};

}  // namespace alvor
