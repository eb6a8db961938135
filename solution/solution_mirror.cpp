#include "solution/solution_mirror.h"

#include <algorithm>

namespace alvor {

std::optional<std::string> SolutionMirror::apply(const Delta& delta) {
  if (auto fault = fault_in(delta)) return fault;
  for (const LeafValue& value : delta.values) set(value);
  steps_.insert(steps_.end(), delta.steps.begin(), delta.steps.end());
  revision_ = delta.to_revision;
  head_ = delta.head;
  return std::nullopt;
}

std::optional<std::string> SolutionMirror::fault_in(const Delta& delta) const {
  if (delta.from_revision != revision_)
    return "the delta starts at revision " + std::to_string(delta.from_revision) + " but the mirror is at " +
           std::to_string(revision_);
  if (delta.to_revision < revision_ || delta.head < delta.to_revision) return "the delta goes backwards";
  std::vector<PatchId> patches;
  patches.reserve(delta.values.size());
  for (const LeafValue& value : delta.values) patches.push_back(value.patch);
  std::ranges::sort(patches, {}, &PatchId::range_min);
  for (std::size_t i = 0; i < patches.size(); ++i) {
    if (!patches[i].is_valid()) return "patch id " + std::to_string(patches[i].bits()) + " is not one";
    const bool overlaps = i > 0 && patches[i].range_min() <= patches[i - 1].range_max();
    if (overlaps || inner_.contains(patches[i]))
      return "patch " + std::to_string(patches[i].bits()) + " is split further elsewhere";
  }
  return std::nullopt;
}

void SolutionMirror::set(const LeafValue& value) {
  const auto found = leaves_.find(value.patch);
  if (found == leaves_.end()) split_down_to(value.patch);
  leaves_[value.patch] = value.irradiance;
}

// The siblings met on the way down inherit what their parent had, until their own values arrive.
void SolutionMirror::split_down_to(PatchId patch) {
  PatchId holder = patch;
  while (!holder.is_root() && !leaves_.contains(holder)) holder = holder.parent();
  const auto found = leaves_.find(holder);
  const RgbF inherited = found == leaves_.end() ? RgbF{} : found->second;
  if (found != leaves_.end()) leaves_.erase(found);
  for (int level = holder.level(); level < patch.level(); ++level) {
    const PatchId at = patch.ancestor(level);
    inner_.insert(at);
    for (int k = 0; k < 4; ++k)
      if (at.child(k) != patch.ancestor(level + 1)) leaves_[at.child(k)] = inherited;
  }
}

std::vector<LeafValue> SolutionMirror::leaves() const {
  std::vector<LeafValue> all;
  all.reserve(leaves_.size());
  for (const auto& [patch, irradiance] : leaves_) all.push_back({patch, irradiance});
  std::ranges::sort(all, {}, &LeafValue::patch);
  return all;
}

}  // namespace alvor
