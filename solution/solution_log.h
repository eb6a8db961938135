#pragma once
// The state of a growing solution: newest value per leaf and the revision at which it last changed.

#include "solution/leaf_value.h"
#include "solution/plain_bytes.h"
#include "solution/shared_exponent.h"
#include "solution/state_hash.h"

#include <condition_variable>
#include <cstddef>
#include <functional>
#include <limits>
#include <mutex>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace alvor {

/// How closely a watcher follows.
enum class Detail : std::uint8_t {
  display,  ///< a leaf is told again when it differs from what was told by more than the displayed error; shared exponents
  exact,    ///< every change, as float32
};

/// A place in the stream. Leaves are told in rounds, in the order of their ids: a round tells all that changed after `base`, and
/// leaves the mirror complete up to `goal`, which is the head when the round began.
struct Cursor {
  std::uint64_t base = 0;  ///< the mirror is complete up to this revision
  std::uint64_t goal = 0;  ///< of the round that is under way; 0 between rounds
  std::uint64_t told = 0;  ///< bits of the last id that the round has passed; 0 between rounds
  bool is_inside_round() const { return told != 0; }
  friend bool operator==(const Cursor&, const Cursor&) = default;
};

/// What changed after a cursor. `whole()` says that nothing newer is left: a mirror that applied it equals `to_revision`. After a
/// page that does not end its round the mirror is between revisions.
struct Delta {
  Detail detail = Detail::exact;
  SharedExponent coding{0};                 ///< in which every value of the display detail is exact
  std::uint64_t from_revision = 0;          ///< the mirror must be at this revision
  std::uint64_t to_revision = 0;            ///< the mirror is then complete up to this revision
  std::uint64_t head = 0;                   ///< newest revision when the delta was made
  std::optional<std::uint64_t> state_hash;  ///< of all leaves as they are told; set if whole()
  Cursor next;                              ///< where the next page starts
  std::vector<LeafValue> values;            ///< ascending, disjoint
  std::vector<Step> steps;                  ///< every step with from_revision < revision <= to_revision
  bool whole() const { return to_revision == head; }
};

/// Thread-safe. One writer publishes, any number of readers ask. Values are state, not a queue: a slow reader gets the newest
/// value of each leaf once, and the memory held (32 bytes a leaf) does not grow with the number or the slowness of readers.
/// Blocks of leaves know their newest revision: what did not change is not looked at.
class SolutionLog {
 public:
  static constexpr std::size_t unlimited = std::numeric_limits<std::size_t>::max();

  SolutionLog() = default;
  /// As it was saved, by this version of the program or an older one; it goes on from there. Throws BadBytes.
  explicit SolutionLog(PlainReader& saved);
  /// All there is, whether it is closed or not excepted. Not while publishing: the writer's thread may call it.
  void save(PlainWriter& out) const;

  /// Makes the next revision. A value for a patch deeper than the log holds splits its ancestor; leaves implied by that and not
  /// given inherit. `step.revision` and `step.step` are filled in here. Requires: `changed` ascends, no patch of it contains
  /// another or a leaf that is held and smaller; irradiance is finite and not negative.
  void publish(std::span<const LeafValue> changed, Step step);
  /// No revision will follow. Wakes the listeners.
  void close();

  /// At most `max_values` (1 or more) values of the round at `cursor`, or of the next.
  /// Requires: cursor.base <= head().
  Delta since(const Cursor& cursor, Detail detail = Detail::exact, std::size_t max_values = unlimited) const;

  std::uint64_t head() const;
  bool closed() const;
  Step last_step() const;
  std::vector<Step> steps() const;
  /// All leaves in the order of their ids.
  std::vector<LeafValue> leaves(Detail detail = Detail::exact) const;

  /// Waits until head() > revision or closed().
  void wait_beyond(std::uint64_t revision) const;

  /// `wake` is called after every publish and on close, from the writer's thread, without the log's lock held. It must be
  /// quick and must not publish. Returns a handle for `forget`; after `forget` returns, `wake` is not running and will not run.
  using Listener = std::function<void()>;
  std::uint64_t listen(Listener wake);
  void forget(std::uint64_t handle);

 private:
  using Revision = std::uint32_t;
  /// What of a leaf is told at one detail.
  struct Tier {
    std::vector<Revision> changed_at;  ///< by leaf
    std::vector<Revision> newest;      ///< by block
    StateHash hash;
  };
  struct Leaves {
    std::vector<PatchId> patch;  ///< ascending
    std::vector<RgbF> irradiance;
    std::vector<std::uint32_t> shown;  ///< by coding_
    Tier display, exact;
  };
  void load_unmarked(PlainReader& saved);
  void load(PlainReader& saved, std::uint32_t version);
  void split_for(std::span<const LeafValue> changed);
  void make_room_for(std::span<const LeafValue> changed);
  /// Or is new.
  bool has_changed(std::size_t leaf, const RgbF& irradiance) const {
    return leaves_.irradiance[leaf] != irradiance || leaves_.display.changed_at[leaf] == head_;
  }
  void set(std::size_t leaf, const RgbF& irradiance, double displayed_error, double mean);
  void show(std::size_t leaf, std::uint32_t word);
  void note_change(Tier& tier, std::size_t leaf);
  void sum_up();
  const Tier& tier(Detail detail) const { return detail == Detail::display ? leaves_.display : leaves_.exact; }
  LeafValue value(std::size_t leaf, Detail detail) const {
    return {leaves_.patch[leaf], detail == Detail::exact ? leaves_.irradiance[leaf] : coding_.unpack(leaves_.shown[leaf])};
  }
  bool collect(Delta& delta, std::uint64_t base, std::uint64_t told, std::size_t max_values) const;
  void wake_listeners();

  mutable std::mutex lock_;
  mutable std::condition_variable changed_;
  Leaves leaves_;
  SharedExponent coding_{0};
  bool has_coding_ = false;
  double sum_ = 0;  ///< of the means of all leaves
  /// What is displayed of all leaves was within this error when they were looked at last, as long as the mean is not below that
  /// one.
  double checked_error_ = std::numeric_limits<double>::infinity(), checked_mean_ = 0;
  std::vector<Step> steps_;
  std::uint64_t head_ = 0;
  bool closed_ = false;

  std::mutex listeners_lock_;
  std::vector<std::pair<std::uint64_t, Listener>> listeners_;
  std::uint64_t next_handle_ = 1;
};

}  // namespace alvor
