#pragma once
// The state of a growing solution: newest value per leaf and the revision at which it last changed.

#include "solution/leaf_value.h"

#include <condition_variable>
#include <cstddef>
#include <functional>
#include <limits>
#include <mutex>
#include <span>
#include <unordered_map>
#include <vector>

namespace alvor {

/// A place in the stream: everything up to and including (revision, patch) in that order has been sent.
struct Cursor {
  std::uint64_t revision = 0;
  PatchId patch = PatchId::from_bits(std::numeric_limits<std::uint64_t>::max());
  friend auto operator<=>(const Cursor&, const Cursor&) = default;
};

/// What changed after a cursor. `whole()` says that nothing newer is left: a mirror that applied it equals `to_revision`.
/// A delta that is one page of several leaves the mirror between revisions until the last page.
struct Delta {
  std::uint64_t from_revision = 0;  ///< the mirror must be at this revision
  std::uint64_t to_revision = 0;    ///< the mirror is then complete up to this revision
  std::uint64_t head = 0;           ///< newest revision when the delta was made
  Cursor next;                      ///< where the next page starts
  std::vector<LeafValue> values;
  std::vector<Step> steps;  ///< every step with from_revision < revision <= to_revision
  bool whole() const { return to_revision == head; }
};

/// Thread-safe. One writer publishes, any number of readers ask. Values are state, not a queue: a slow reader gets the newest
/// value of each leaf once, and the memory held does not grow with the number or the slowness of readers.
class SolutionLog {
 public:
  static constexpr std::size_t unlimited = std::numeric_limits<std::size_t>::max();

  /// Makes the next revision. A value for a patch deeper than the log holds replaces its ancestor: the writer must then give
  /// values for all of the ancestor's new leaves in the same call. `step.revision` and `step.step` are filled in here.
  void publish(std::span<const LeafValue> changed, Step step);
  /// No revision will follow. Wakes the listeners.
  void close();

  /// At most `max_values` values changed after `cursor`, oldest first. The order within a revision is that of the ids.
  Delta since(Cursor cursor, std::size_t max_values = unlimited) const;

  std::uint64_t head() const;
  bool closed() const;
  Step last_step() const;
  std::vector<Step> steps() const;
  /// All leaves in the order of their ids.
  std::vector<LeafValue> leaves() const;

  /// Waits until head() > revision or closed().
  void wait_beyond(std::uint64_t revision) const;

  /// `wake` is called after every publish and on close, from the writer's thread, without the log's lock held. It must be
  /// quick and must not publish. Returns a handle for `forget`; after `forget` returns, `wake` is not running and will not run.
  using Listener = std::function<void()>;
  std::uint64_t listen(Listener wake);
  void forget(std::uint64_t handle);

 private:
  struct Slot {
    LeafValue value;
    std::uint64_t revision;
  };
  void replace_ancestor(PatchId patch);
  void wake_listeners();

  mutable std::mutex lock_;
  mutable std::condition_variable changed_;
  std::vector<Slot> slots_;
  std::unordered_map<PatchId, std::size_t> slot_of_;
  std::vector<Step> steps_;
  std::uint64_t head_ = 0;
  bool closed_ = false;

  std::mutex listeners_lock_;
  std::vector<std::pair<std::uint64_t, Listener>> listeners_;
  std::uint64_t next_handle_ = 1;
};

}  // namespace alvor
