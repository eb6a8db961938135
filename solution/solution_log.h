#pragma once
// The log of a growing solution: the newest value of each leaf, and the revision at which it last changed.

#include "solution/leaf_value.h"
#include "solution/plain_bytes.h"
#include "solution/shared_exponent.h"
#include "solution/state_hash.h"
#include "solution/told_error.h"

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

/// How exactly a watcher wants the leaf values.
enum class Detail : std::uint8_t {
  display,  ///< rounded values; a leaf is sent again once it differs by more than the displayed error
  exact,    ///< every change, as float32
};

/// A reader's position among the told errors of leaves. They are told again for all leaves whenever the solver estimated them, in
/// rounds of pages like the values.
struct ErrorCursor {
  bool are_wanted = false;
  std::uint64_t base = 0;  ///< the revision whose errors the mirror has; 0: none
  std::uint64_t goal = 0;  ///< the revision whose errors the current round tells; 0 between rounds
  std::uint64_t told = 0;  ///< bits of the last id that the current round has told; 0 between rounds
  friend bool operator==(const ErrorCursor&, const ErrorCursor&) = default;
};

/// A reader's position in the stream. Changed leaves are sent in rounds, each in the order of patch ids. A round sends all leaves
/// that changed after `base`; then the mirror is complete up to `goal`, which was the head when the round began.
struct Cursor {
  std::uint64_t base = 0;  ///< the mirror is complete up to this revision
  std::uint64_t goal = 0;  ///< the goal of the current round; 0 between rounds
  std::uint64_t told = 0;  ///< bits of the last id that the current round has sent; 0 between rounds
  ErrorCursor errors;
  bool is_inside_round() const { return told != 0; }
  /// Returns whether a page is missing of values or errors that were begun.
  bool is_between_pages() const { return told != 0 || errors.told != 0; }
  friend bool operator==(const Cursor&, const Cursor&) = default;
};

/// The changes after a cursor, or one page of them. If whole(), nothing newer is left, and a mirror that applied the delta equals
/// `to_revision`. After a page that does not end its round, the mirror lies between two revisions.
struct Delta {
  Detail detail = Detail::exact;
  SharedExponent coding{0};                 ///< represents every value of the display detail exactly
  std::uint64_t from_revision = 0;          ///< the mirror must be at this revision
  std::uint64_t to_revision = 0;            ///< the mirror is then complete up to this revision
  std::uint64_t edits_before = 0;           ///< Step::edits at `from_revision`; 0 at none
  std::uint64_t edits_after = 0;            ///< Step::edits at the end of the round; 0 at none
  std::uint64_t head = 0;                   ///< newest revision when the delta was made
  std::optional<std::uint64_t> state_hash;  ///< StateHash of all leaves at this detail; set if whole()
  Cursor next;                              ///< the position at which the next page starts
  std::vector<LeafValue> values;            ///< ascending, disjoint
  std::vector<Step> steps;                  ///< every step with from_revision < revision <= to_revision
  std::optional<ErrorPage> errors;          ///< of leaves of the state after this delta; only if whole()
  bool has_more_errors = false;             ///< errors are left to tell to a mirror that applied the delta
  bool whole() const { return to_revision == head; }
};

/// Thread-safe: one writer publishes, any number of readers ask. The log keeps the newest value of each leaf and no queue: a slow
/// reader gets each leaf once, and memory (33 bytes a leaf) depends neither on the number of readers nor on their speed. Each
/// block of leaves knows its newest revision, so that readers skip unchanged blocks.
class SolutionLog {
 public:
  static constexpr std::size_t unlimited = std::numeric_limits<std::size_t>::max();

  SolutionLog() = default;
  /// Restores a log that save() wrote, of this version of the program or an older one; publishing continues from there. Throws
  /// BadBytes.
  explicit SolutionLog(PlainReader& saved);
  /// Writes everything except whether the log is closed. Other calls wait until it has returned.
  void save(PlainWriter& out) const;

  /// Makes the next revision. A value for a patch deeper than the log holds splits the ancestor; siblings that this implies, and
  /// that are not in `changed`, inherit the ancestor's value. A value for a patch within which the log holds leaves, as a solve
  /// of an edited scene that begins anew may publish, makes them one leaf. Fills in `step.revision` and `step.step`. Requires:
  /// the log is open; `changed` ascends; no patch of it contains another; irradiance is finite and not negative. `errors` are the
  /// told errors of the patches in `changed` (see ErrorCoding), or nothing if they were not estimated anew.
  void publish(std::span<const LeafValue> changed, Step step, std::span<const float> errors = {});
  /// Says that no revision will follow. Wakes the listeners.
  void close();
  /// Takes close() back: further revisions may follow.
  void reopen();

  /// Returns at most `max_values` (1 or more) values of the round at `cursor`, or of the next round. Requires: cursor.base <=
  /// head(). If the cursor wants errors and the delta is whole(), it holds at most errors_per_page(max_values) of them.
  Delta since(const Cursor& cursor, Detail detail = Detail::exact, std::size_t max_values = unlimited) const;

  std::uint64_t head() const;
  /// Returns whether there are errors that a reader there wants and does not have.
  bool has_errors_after(const ErrorCursor& cursor) const;
  bool closed() const;
  Step last_step() const;
  std::vector<Step> steps() const;
  /// Returns all leaves in the order of their ids.
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
  /// The change records of all leaves at one detail.
  struct Tier {
    std::vector<Revision> changed_at;  ///< newest revision that changed the leaf, by leaf
    std::vector<Revision> newest;      ///< newest revision that changed a leaf of the block, by block
    StateHash hash;
  };
  struct Leaves {
    std::vector<PatchId> patch;  ///< ascending
    std::vector<RgbF> irradiance;
    std::vector<std::uint32_t> shown;  ///< displayed values, packed by coding_
    std::vector<std::uint8_t> error;   ///< told errors, packed by error_coding_; 0 until they are told
    Tier display, exact;
  };
  void load_unmarked(PlainReader& saved);
  void load(PlainReader& saved, std::uint32_t version);
  void load_errors(PlainReader& saved);
  void retile_for(std::span<const LeafValue> changed);
  void make_room_for(std::span<const LeafValue> changed);
  /// Returns whether `irradiance` differs from the held value, or the leaf is new in this revision.
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
  void tell_errors(std::span<const std::size_t> places, std::span<const float> errors);
  void collect_errors(const ErrorCursor& cursor, std::size_t max_errors, Delta& delta) const;
  std::uint64_t goal_of(const ErrorCursor& cursor) const { return cursor.told != 0 ? cursor.goal : errors_revision_; }
  bool collect(Delta& delta, std::uint64_t base, std::uint64_t told, std::size_t max_values) const;
  void wake_listeners();

  mutable std::mutex lock_;
  mutable std::condition_variable changed_;
  Leaves leaves_;
  SharedExponent coding_{0};
  bool has_coding_ = false;
  ErrorCoding error_coding_{0};
  std::uint64_t errors_revision_ = 0;  ///< the newest revision that told errors; 0: none did
  double sum_ = 0;                     ///< sum over all leaves of the mean of the bands
  /// At the last look at all leaves, every displayed value was within this error. That still holds while the mean is at least
  /// `checked_mean_`.
  double checked_error_ = std::numeric_limits<double>::infinity(), checked_mean_ = 0;
  std::vector<Step> steps_;
  std::uint64_t head_ = 0;
  bool closed_ = false;

  std::mutex listeners_lock_;
  std::vector<std::pair<std::uint64_t, Listener>> listeners_;
  std::uint64_t next_handle_ = 1;
};

}  // namespace alvor
