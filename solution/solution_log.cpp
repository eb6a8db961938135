#include "solution/solution_log.h"

#include <algorithm>

namespace alvor {

void SolutionLog::publish(std::span<const LeafValue> changed, Step step) {
  {
    std::scoped_lock hold(lock_);
    ++head_;
    for (const LeafValue& value : changed) {
      const auto found = slot_of_.find(value.patch);
      if (found != slot_of_.end()) {
        slots_[found->second] = {value, head_};
        continue;
      }
      replace_ancestor(value.patch);
      slot_of_.emplace(value.patch, slots_.size());
      slots_.push_back({value, head_});
    }
    step.revision = head_;
    step.step = steps_.size();
    steps_.push_back(step);
    changed_.notify_all();
  }
  wake_listeners();
}

void SolutionLog::replace_ancestor(PatchId patch) {
  while (!patch.is_root()) {
    patch = patch.parent();
    const auto found = slot_of_.find(patch);
    if (found == slot_of_.end()) continue;
    const std::size_t hole = found->second;
    slot_of_.erase(found);
    if (hole + 1 != slots_.size()) {
      slots_[hole] = slots_.back();
      slot_of_[slots_[hole].value.patch] = hole;
    }
    slots_.pop_back();
    return;
  }
}

void SolutionLog::close() {
  {
    std::scoped_lock hold(lock_);
    closed_ = true;
    changed_.notify_all();
  }
  wake_listeners();
}

Delta SolutionLog::since(Cursor cursor, std::size_t max_values) const {
  std::scoped_lock hold(lock_);
  const auto place = [](const Slot& slot) { return Cursor{slot.revision, slot.value.patch}; };
  std::vector<const Slot*> newer;
  for (const Slot& slot : slots_)
    if (place(slot) > cursor) newer.push_back(&slot);
  std::ranges::sort(newer, {}, [&](const Slot* slot) { return place(*slot); });

  Delta delta;
  delta.from_revision = cursor.patch == Cursor{}.patch ? cursor.revision : cursor.revision - 1;
  delta.head = head_;
  const bool cut = newer.size() > max_values;
  if (cut) newer.resize(max_values);
  for (const Slot* slot : newer) delta.values.push_back(slot->value);
  delta.next = cut ? place(*newer.back()) : Cursor{head_};
  delta.to_revision = cut ? delta.next.revision - 1 : head_;
  for (const Step& step : steps_)
    if (step.revision > delta.from_revision && step.revision <= delta.to_revision) delta.steps.push_back(step);
  return delta;
}

std::uint64_t SolutionLog::head() const {
  std::scoped_lock hold(lock_);
  return head_;
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

std::vector<LeafValue> SolutionLog::leaves() const {
  std::vector<LeafValue> all;
  {
    std::scoped_lock hold(lock_);
    all.reserve(slots_.size());
    for (const Slot& slot : slots_) all.push_back(slot.value);
  }
  std::ranges::sort(all, {}, &LeafValue::patch);
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
