#include "solution/solution_mirror.h"

#include "solution/leaf_merge.h"

#include <algorithm>
#include <cassert>
#include <limits>

namespace alvor {

namespace {

std::optional<std::string> fault_in_patches(std::span<const LeafValue> values) {
  for (std::size_t n = 0; n < values.size(); ++n) {
    const PatchId patch = values[n].patch;
    if (!patch.is_valid()) return "patch id " + std::to_string(patch.bits()) + " is not one";
    if (n > 0 && patch.range_min() <= values[n - 1].patch.range_max())
      return "patch " + std::to_string(patch.bits()) + " overlaps the one before it";
    if (n > 0 && !values[n - 1].patch.agrees_on_splits(patch))
      return "patch " + std::to_string(patch.bits()) + " says of a common ancestor that it is split in another way";
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::string> SolutionMirror::apply(const Delta& delta) {
  if (auto fault = fault_in(delta)) return fault;
  std::vector<std::size_t> places;
  if (!find_places(patches_, delta.values, places)) {
    retile_for(delta.values);
    [[maybe_unused]] const bool has_all = find_places(patches_, delta.values, places);
    assert(has_all);
  }
  for (std::size_t n = 0; n < places.size(); ++n) {
    RgbF& held = irradiance_[places[n]];
    hash_.remove({delta.values[n].patch, held});
    held = delta.values[n].irradiance;
    hash_.add(delta.values[n]);
  }
  steps_.insert(steps_.end(), delta.steps.begin(), delta.steps.end());
  revision_ = delta.to_revision;
  head_ = delta.head;
  if (delta.state_hash && *delta.state_hash != hash_.bits())
    return "the state at revision " + std::to_string(revision_) + " has another hash than the server's";
  misses_errors_ = delta.has_more_errors;
  return delta.errors ? take_errors(*delta.errors) : std::nullopt;
}

std::optional<std::string> SolutionMirror::take_errors(const ErrorPage& page) {
  const auto first = std::ranges::lower_bound(patches_, page.first);
  const auto left = static_cast<std::size_t>(patches_.end() - first);
  if (!whole() || left == 0 || *first != page.first || page.codes.size() > left)
    return "it tells errors of leaves that are not there";
  errors_.resize(patches_.size(), std::numeric_limits<float>::quiet_NaN());
  std::ranges::transform(page.codes, errors_.begin() + (first - patches_.begin()),
                         [&](std::uint8_t code) { return page.coding.unpack(code); });
  return std::nullopt;
}

std::optional<std::string> SolutionMirror::fault_in(const Delta& delta) const {
  if (delta.from_revision != revision_)
    return "the delta starts at revision " + std::to_string(delta.from_revision) + " but the mirror is at " +
           std::to_string(revision_);
  if (delta.to_revision < revision_ || delta.head < delta.to_revision) return "the delta goes backwards";
  return fault_in_patches(delta.values);
}

void SolutionMirror::retile_for(const std::vector<LeafValue>& values) {
  std::vector<PatchId> patches;
  std::vector<RgbF> irradiance;
  std::vector<float> errors;
  patches.reserve(patches_.size() + values.size());
  irradiance.reserve(patches_.size() + values.size());
  const auto append = [&](PatchId patch, std::size_t from) {
    patches.push_back(patch);
    irradiance.push_back(from == no_leaf ? RgbF{} : irradiance_[from]);
    if (!errors_.empty()) errors.push_back(from == no_leaf ? 0 : errors_[from]);
  };
  LeafMerge(
      std::span<const PatchId>(patches_), std::span(values), [&](std::size_t i) { append(patches_[i], i); },
      [&](std::size_t from, std::size_t j) { append(values[j].patch, from); },
      [&](std::size_t from, PatchId patch, bool) { append(patch, from); })
      .run();
  patches_ = std::move(patches);
  irradiance_ = std::move(irradiance);
  errors_ = std::move(errors);
  hash_ = {};
  for (std::size_t n = 0; n < patches_.size(); ++n) hash_.add({patches_[n], irradiance_[n]});
}

std::vector<LeafValue> SolutionMirror::leaves() const {
  std::vector<LeafValue> all;
  all.reserve(patches_.size());
  for (std::size_t n = 0; n < patches_.size(); ++n) all.push_back({patches_[n], irradiance_[n]});
  return all;
}

}  // namespace alvor
