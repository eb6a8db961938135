#include "solution/solution_log.h"

#include "solution/leaf_merge.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace alvor {

namespace {

constexpr std::size_t leaves_per_block = 512;
// All displayed values are checked again when the mean falls below this fraction of its value at the last check.
constexpr double mean_may_fall_to = 0.9;
// Darker leaves may be off by as much as if their irradiance were this fraction of the mean.
constexpr double darkest = 0.125;

/// Returns how many of a mantissa's nine bits to drop (0 to 4): as many as keep the rounding error below `displayed_error`. Holds
/// because the largest mantissa is at least 256.
int dropped_bits(double displayed_error) { return displayed_error > 0 ? std::clamp(std::ilogb(512 * displayed_error), 0, 4) : 0; }

std::size_t blocks_of(std::size_t leaves) { return (leaves + leaves_per_block - 1) / leaves_per_block; }

}  // namespace

void SolutionLog::publish(std::span<const LeafValue> changed, Step step, std::span<const float> errors) {
  {
    std::scoped_lock hold(lock_);
    assert(head_ < std::numeric_limits<Revision>::max());
    assert(std::ranges::is_sorted(changed, {}, &LeafValue::patch));
    ++head_;
    make_room_for(changed);
    std::vector<std::size_t> places;
    if (!find_places(leaves_.patch, changed, places)) {
      retile_for(changed);
      [[maybe_unused]] const bool has_all = find_places(leaves_.patch, changed, places);
      assert(has_all);
    }
    const double mean = leaves_.patch.empty() ? 0 : sum_ / static_cast<double>(leaves_.patch.size());
    const bool is_checked = step.displayed_error >= checked_error_ && mean >= checked_mean_;
    const double counted_mean = is_checked ? mean : mean_may_fall_to * mean;
    for (std::size_t n = 0; n < changed.size(); ++n)
      if (!is_checked || has_changed(places[n], changed[n].irradiance))
        set(places[n], changed[n].irradiance, step.displayed_error, counted_mean);
    if (!is_checked && changed.size() == leaves_.patch.size())
      checked_error_ = step.displayed_error, checked_mean_ = counted_mean;
    if (!errors.empty()) tell_errors(places, errors);
    step.revision = head_;
    step.step = steps_.size();
    steps_.push_back(step);
    changed_.notify_all();
  }
  wake_listeners();
}

/// Splits and merges leaves so that each patch of `changed` is a leaf. New leaves count as changed in this revision, whatever
/// their values; implied siblings keep the revision of the leaf they inherit from.
void SolutionLog::retile_for(std::span<const LeafValue> changed) {
  Leaves next;
  const auto append = [&](PatchId patch, std::size_t from, bool is_new) {
    const bool known = from != no_leaf;
    next.patch.push_back(patch);
    next.irradiance.push_back(known ? leaves_.irradiance[from] : RgbF{});
    next.shown.push_back(known ? leaves_.shown[from] : 0);
    next.error.push_back(known ? leaves_.error[from] : 0);
    const auto now = static_cast<Revision>(head_);
    next.display.changed_at.push_back(is_new ? now : leaves_.display.changed_at[from]);
    next.exact.changed_at.push_back(is_new ? now : leaves_.exact.changed_at[from]);
  };
  const auto keep = [&](std::size_t i) { append(leaves_.patch[i], i, false); };
  const auto set = [&](std::size_t from, std::size_t j) {
    append(changed[j].patch, from, from == no_leaf || leaves_.patch[from] != changed[j].patch);
  };
  const auto inherit = [&](std::size_t from, PatchId patch, bool is_of_many) {
    append(patch, from, from == no_leaf || is_of_many);
  };
  LeafMerge(std::span<const PatchId>(leaves_.patch), changed, keep, set, inherit).run();
  leaves_ = std::move(next);
  sum_up();
}

void SolutionLog::sum_up() {
  sum_ = 0;
  for (const RgbF& irradiance : leaves_.irradiance) sum_ += irradiance.mean();
  for (const Detail detail : {Detail::display, Detail::exact}) {
    Tier& all = detail == Detail::display ? leaves_.display : leaves_.exact;
    all.hash = {};
    all.newest.assign(blocks_of(leaves_.patch.size()), 0);
    for (std::size_t leaf = 0; leaf < leaves_.patch.size(); ++leaf) {
      all.hash.add(value(leaf, detail));
      Revision& newest = all.newest[leaf / leaves_per_block];
      newest = std::max(newest, all.changed_at[leaf]);
    }
  }
}

/// Adapts the coding to the brightest value. When the scale changes, every displayed value changes.
void SolutionLog::make_room_for(std::span<const LeafValue> changed) {
  float largest = 0;
  for (const LeafValue& value : changed) largest = std::max(largest, value.irradiance.max());
  if (largest == 0 || (has_coding_ && largest <= coding_.largest())) return;
  coding_ = SharedExponent::for_values_up_to(largest);
  has_coding_ = true;
  for (std::size_t leaf = 0; leaf < leaves_.patch.size(); ++leaf) {
    leaves_.shown[leaf] = coding_.pack(leaves_.irradiance[leaf]);
    leaves_.display.changed_at[leaf] = static_cast<Revision>(head_);
  }
  sum_up();
}

void SolutionLog::set(std::size_t leaf, const RgbF& irradiance, double displayed_error, double mean) {
  RgbF& held = leaves_.irradiance[leaf];
  if (held != irradiance) {
    sum_ += double(irradiance.mean()) - held.mean();
    leaves_.exact.hash.remove(value(leaf, Detail::exact));
    held = irradiance;
    leaves_.exact.hash.add(value(leaf, Detail::exact));
    note_change(leaves_.exact, leaf);
  }
  const bool is_new = leaves_.display.changed_at[leaf] == head_;
  const double off = absolute(irradiance - coding_.unpack(leaves_.shown[leaf])).max();
  if (is_new || off > displayed_error * std::max<double>(irradiance.max(), darkest * mean))
    show(leaf, coding_.pack(irradiance, dropped_bits(displayed_error)));
}

void SolutionLog::show(std::size_t leaf, std::uint32_t word) {
  if (word == leaves_.shown[leaf]) return;
  leaves_.display.hash.remove(value(leaf, Detail::display));
  leaves_.shown[leaf] = word;
  leaves_.display.hash.add(value(leaf, Detail::display));
  note_change(leaves_.display, leaf);
}

void SolutionLog::tell_errors(std::span<const std::size_t> places, std::span<const float> errors) {
  assert(errors.size() == places.size());
  error_coding_ = ErrorCoding::for_errors_up_to(std::ranges::max(errors));
  for (std::size_t n = 0; n < errors.size(); ++n) leaves_.error[places[n]] = error_coding_.pack(errors[n]);
  errors_revision_ = head_;
}

void SolutionLog::note_change(Tier& tier, std::size_t leaf) {
  tier.changed_at[leaf] = tier.newest[leaf / leaves_per_block] = static_cast<Revision>(head_);
}

void SolutionLog::reopen() {
  std::scoped_lock hold(lock_);
  closed_ = false;
}

void SolutionLog::close() {
  {
    std::scoped_lock hold(lock_);
    closed_ = true;
    changed_.notify_all();
  }
  wake_listeners();
}

Delta SolutionLog::since(const Cursor& cursor, Detail detail, std::size_t max_values) const {
  std::scoped_lock hold(lock_);
  const std::uint64_t goal = cursor.is_inside_round() ? cursor.goal : head_;
  Delta delta;
  delta.detail = detail;
  delta.coding = coding_;
  delta.from_revision = cursor.base;
  delta.head = head_;
  const bool done = collect(delta, cursor.base, cursor.told, max_values);
  delta.next = done ? Cursor{.base = goal} : Cursor{cursor.base, goal, delta.values.back().patch.bits(), {}};
  delta.next.errors = cursor.errors;
  delta.to_revision = done ? goal : cursor.base;
  if (cursor.base > 0) delta.edits_before = steps_[cursor.base - 1].edits;
  if (goal > 0) delta.edits_after = steps_[goal - 1].edits;
  if (delta.whole()) delta.state_hash = tier(detail).hash.bits();
  delta.steps.assign(steps_.begin() + static_cast<std::ptrdiff_t>(delta.from_revision),
                     steps_.begin() + static_cast<std::ptrdiff_t>(delta.to_revision));
  if (delta.whole()) collect_errors(cursor.errors, errors_per_page(max_values), delta);
  delta.has_more_errors = cursor.errors.are_wanted && goal_of(delta.next.errors) > delta.next.errors.base;
  return delta;
}

void SolutionLog::collect_errors(const ErrorCursor& cursor, std::size_t max_errors, Delta& delta) const {
  const std::uint64_t goal = goal_of(cursor);
  if (!cursor.are_wanted || goal <= cursor.base) return;
  const auto first = std::ranges::upper_bound(leaves_.patch, PatchId::from_bits(cursor.told)) - leaves_.patch.begin();
  const auto begin = leaves_.error.begin() + first;
  const std::size_t left = static_cast<std::size_t>(leaves_.error.end() - begin), count = std::min(left, max_errors);
  const auto last = static_cast<std::size_t>(first) + count - 1;
  if (count > 0)
    delta.errors = {
        leaves_.patch[static_cast<std::size_t>(first)], error_coding_, {begin, begin + static_cast<std::ptrdiff_t>(count)}};
  delta.next.errors =
      count == left ? ErrorCursor{true, goal, 0, 0} : ErrorCursor{true, cursor.base, goal, leaves_.patch[last].bits()};
}

/// Appends changed leaves to `delta`. Returns whether none is left.
bool SolutionLog::collect(Delta& delta, std::uint64_t base, std::uint64_t told, std::size_t max_values) const {
  const Tier& all = tier(delta.detail);
  const auto first = std::ranges::upper_bound(leaves_.patch, PatchId::from_bits(told)) - leaves_.patch.begin();
  for (auto leaf = static_cast<std::size_t>(first); leaf < leaves_.patch.size(); ++leaf) {
    if (all.newest[leaf / leaves_per_block] <= base) {
      leaf = (leaf / leaves_per_block + 1) * leaves_per_block - 1;
      continue;
    }
    if (all.changed_at[leaf] <= base) continue;
    if (delta.values.size() == max_values) return false;
    delta.values.push_back(value(leaf, delta.detail));
  }
  return true;
}

std::uint64_t SolutionLog::head() const {
  std::scoped_lock hold(lock_);
  return head_;
}

bool SolutionLog::has_errors_after(const ErrorCursor& cursor) const {
  std::scoped_lock hold(lock_);
  return cursor.are_wanted && goal_of(cursor) > cursor.base;
}

bool SolutionLog::closed() const {
  std::scoped_lock hold(lock_);
  return closed_;
}

Step SolutionLog::last_step() const {
  std::scoped_lock hold(lock_);
  return steps_.empty() ? Step{} : steps_.back();
}

std::vector<Step> SolutionLog::steps() const {
  std::scoped_lock hold(lock_);
  return steps_;
}

std::vector<LeafValue> SolutionLog::leaves(Detail detail) const {
  std::scoped_lock hold(lock_);
  std::vector<LeafValue> all;
  all.reserve(leaves_.patch.size());
  for (std::size_t leaf = 0; leaf < leaves_.patch.size(); ++leaf) all.push_back(value(leaf, detail));
  return all;
}

void SolutionLog::wait_beyond(std::uint64_t revision) const {
  std::unique_lock hold(lock_);
  changed_.wait(hold, [&] { return closed_ || head_ > revision; });
}

std::uint64_t SolutionLog::listen(Listener wake) {
  std::scoped_lock hold(listeners_lock_);
  listeners_.emplace_back(next_handle_, std::move(wake));
  return next_handle_++;
}

void SolutionLog::forget(std::uint64_t handle) {
  std::scoped_lock hold(listeners_lock_);
  std::erase_if(listeners_, [&](const auto& entry) { return entry.first == handle; });
}

void SolutionLog::wake_listeners() {
  std::scoped_lock hold(listeners_lock_);
  for (const auto& [handle, wake] : listeners_) wake();
}

}  // namespace alvor
