#pragma once
// Limits the server's memory: work is refused before the system would kill the process.

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

namespace alvor {

/// Returns the resident memory of this process, in bytes, with the code that it runs: without that it could not go on.
std::uint64_t resident_bytes();

/// Returns freed memory to the system within a second, on a thread of its own. Memory limits count what the allocator keeps, so
/// call this after much was freed.
void trim_heap_soon();

/// Returns the memory limit of this process's control group, or else the machine's memory, in bytes.
std::uint64_t allowed_memory();

/// Decides whether there is memory for new work, and for what runs. An eighth of the limit stays free, but no less than 64 MiB,
/// or a quarter of a limit below 256 MiB: a solve that is told to end takes that much more until it has. New work leaves a
/// seventh of the rest free, so that it does not end others. Copies share the registered reliefs. Thread-safe.
class MemoryGuard {
 public:
  MemoryGuard() : MemoryGuard(0) {}  ///< a guard without limit
  /// `limit` in bytes; 0: no limit. `used` returns the bytes in use.
  explicit MemoryGuard(std::uint64_t limit, std::uint64_t (*used)() = resident_bytes);

  /// Calls make_room(), then refuse_without_room().
  void admit(const std::string& what, std::uint64_t bytes) const;
  /// Runs the registered reliefs if `bytes` more would not fit. The caller must not hold a lock that one of them takes.
  void make_room(std::uint64_t bytes) const;
  /// Throws RESOURCE_EXHAUSTED, naming `what`, if with `bytes` more too much would be in use for new work.
  void refuse_without_room(const std::string& what, std::uint64_t bytes) const;
  bool has_room(std::uint64_t bytes) const;
  /// Returns whether so much is in use that work must be ended.
  bool is_short() const;
  /// Returns whether it is so even after a relief. For those who look again and again: where it is not, reliefs are run at most
  /// once a second while there is no room for new work.
  bool runs_short() const;
  /// To be called when much is not needed any more: the next relief is run without a pause. Waits for nothing.
  void expect_gain() const;

  std::uint64_t limit() const { return limit_; }
  /// Time between looks at the memory of a process that solves. Measured on two processors: it grows by up to 36 MB meanwhile,
  /// and by 52 MB in 200 ms.
  static constexpr std::chrono::milliseconds between_looks{50};

  /// Registers a function that frees memory nobody needs. It stays registered until the returned handle is destroyed.
  std::shared_ptr<void> relieve_by(std::function<void()> give_back) const;

 private:
  struct Relief;

  std::uint64_t most_of_all() const;
  std::uint64_t most_for_new_work() const;

  std::uint64_t limit_;
  std::uint64_t (*used_)();
  std::shared_ptr<Relief> relief_;
};

}  // namespace alvor
