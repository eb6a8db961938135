// Finds what may be refined after a pass: patches to split, and rows and leaves to give more rays.

#include "radiosity/rays/ray_source.h"
#include "radiosity/solve/pass.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <functional>

namespace alvor {

namespace {

// A level more of shadow rays: how many times the rays, and the share of the variance that it removes (VisibleFraction).
constexpr double times_rays_of_level = 4, removed_by_rays = 7.0 / 8;
// Shadow rays of a leaf of level 0: the geometric mean of 16 and 64. Splitting it costs those of four children.
constexpr double rays_per_leaf = 32, rays_per_leaf_split = 4 * rays_per_leaf;
// Rays that splitting a row costs: four children, a row and 32 shadow rays each.
constexpr double rays_per_row_split = 4 * (rays_per_row + 32);
// Rays above which a row gets no more. Chosen; half and double give the same solutions (docs/design/constants.md).
constexpr std::uint32_t most_rays_per_row = 16 * rays_per_row;
// Rays are not sent where they would remove less than this share of the squared error that the limits keep: removing all of it
// would make the error a tenth smaller. Splits count far less because a dark room beside one that cannot be refined is to be
// split nevertheless. Chosen.
constexpr double worth_rays = 0.2;
// The limits keep a tolerance out of reach if they keep this share of its square: the rest would be paid for dearly. Chosen.
constexpr double out_of_reach = 0.8;
// Where limits keep the tolerance out of reach, refinement ends once the squared error that it can still remove is within the
// squared tolerance, and at most this share of that or of what the limits keep: removing all of it would make the error a quarter
// smaller at most. 0.6 in place of this share: the furnished room takes more rays to 2 % with seven levels than with ten. Chosen.
constexpr double hardly_more = 0.75;

}  // namespace

/// Sets `candidates_`; once a pass, because it takes as long as the estimate of leaves, and a solve that is done needs none.
void Pass::find_candidates() {
  assert(stage_ == Stage::estimated);
  if (has_candidates_) return;
  has_candidates_ = true;
  find_row_candidates();
  find_leaf_candidates();
  if (told_.sampling < 0.5 * told_.mesh() && std::ranges::none_of(candidates_, &Candidate::splits)) candidates_.clear();
  drop_what_does_not_help();
}

void Pass::find_row_candidates() {
  const auto patches = system_->patches();
  for (std::size_t p = 0; p < patches.size(); ++p) {
    const NodeIndex row = system_->rows()[p];
    const double noise = visible_area(p) * state_.field.fit(row).variance, rays = state_.rows[row].ray_count();
    if (noise > 0 && rays < most_rays_per_row)
      candidates_.push_back({Candidate::Kind::add_rays, row, noise * rays_per_row / (rays + rays_per_row), rays_per_row});
  }
  const auto error_of = [&](std::size_t p) {
    const auto& [square, by_origins] = row_errors_[p];
    // Direct light tells the direction of a line more surely than the noisy rays of a row.
    const Split by_light = patches[p].leaf_count == 1 ? leaf_errors_[patches[p].first_leaf].split : Split::quarters;
    return SplitError{square, by_light == Split::quarters ? by_origins : by_light};
  };
  std::vector<std::uint8_t> may_split(patches.size());
  tbb::parallel_for(std::size_t{0}, patches.size(),
                    [&](std::size_t p) { may_split[p] = state_.forests.may_split_row(system_->rows()[p], error_of(p).split); });
  for (std::size_t p = 0; p < patches.size(); ++p)
    add_split(Candidate::Kind::split_row, system_->rows()[p], error_of(p), may_split[p]);
}

void Pass::find_leaf_candidates() {
  const auto leaves = system_->leaves();
  std::vector<std::uint8_t> may_split(leaves.size());
  std::vector<double> noise(leaves.size());
  tbb::parallel_for(std::size_t{0}, leaves.size(), [&](std::size_t n) {
    may_split[n] = state_.forests.may_split_leaf(leaves[n], leaf_errors_[n].split);
    noise[n] = shown_noise(n);
  });
  std::vector<SplitError> errors(leaf_errors_);
  for (std::size_t n = 0; n < leaves.size(); ++n) errors[n].square = heed_noise(n, may_split[n], noise[n]);
  for (std::size_t n = 0; n < leaves.size(); ++n) add_split(Candidate::Kind::split_leaf, leaves[n], errors[n], may_split[n]);
}

/// Adds a candidate that splits a patch, or its error to what lasts where limits forbid it.
void Pass::add_split(Candidate::Kind kind, NodeIndex patch, const SplitError& error, bool may_split) {
  if (!state_.plan.needs(Feature::refinement) || error.square <= 0) return;
  const bool is_leaf = kind == Candidate::Kind::split_leaf;
  const double rays = is_leaf ? rays_per_leaf_split * state_.direct.ray_share(patch) : rays_per_row_split;
  const Candidate candidate{kind, patch, error.square, rays, error.split};
  if (may_split) candidates_.push_back(candidate);
  else lasting_error_ += told_square(candidate);
}

/// Returns how much of the squared error of a leaf, integrated over it, splitting the leaf would remove; `noise` is its
/// shown_noise(). Both parts of the error, what interpolation misses and the noise of shadow rays, go where the edge of a shadow
/// leaves the smaller leaves. Where noise is the larger part, there is no edge to find, and smaller leaves are as noisy: then
/// this adds a candidate that gives the leaf more shadow rays instead. So it does where a leaf cannot be split, and noise of its
/// origins may be part of what is taken for missed.
double Pass::heed_noise(std::size_t place, bool may_split, double noise) {
  const NodeIndex leaf = system_->leaves()[place];
  const double missed = std::max(0.0, leaf_errors_[place].square);
  const double doubtful = may_split ? 0 : system_->visible_area(place) * noise_of_origins * state_.direct[leaf].origin_variance;
  if (state_.direct.may_add_rays(leaf) && noise + doubtful > missed) {
    const double in_doubt = std::min(missed, doubtful) / 2, removed = removed_by_rays * noise + in_doubt;
    if (!may_split) lasting_error_ += unseen_detail * (missed - in_doubt);
    candidates_.push_back(
        {Candidate::Kind::add_shadow_rays, leaf, removed, times_rays_of_level * rays_per_leaf * state_.direct.ray_share(leaf)});
    return 0;
  }
  if (noise <= missed) return missed + noise;
  lasting_error_ += noise;
  return missed;
}

/// Returns the told squared error, integrated over the scene, of which refining a candidate removes a part.
double Pass::told_square(const Candidate& candidate) const {
  switch (candidate.kind) {
    case Candidate::Kind::split_leaf: return unseen_detail * candidate.squared_error;
    case Candidate::Kind::add_rays:  // further rounds remove the rest of the noise
      return candidate.squared_error * (state_.rows[candidate.patch].ray_count() + rays_per_row) / rays_per_row;
    default: return candidate.squared_error;
  }
}

/// Drops candidates where limits keep the tolerance out of reach: those that add rays if all of these would hardly reduce the
/// error, then all if what they can remove is little enough.
void Pass::drop_what_does_not_help() {
  const double allowed = state_.options.tolerance * state_.options.tolerance * told_scale_;
  if (state_.options.is_by_place() || lasting_error_ <= out_of_reach * allowed) return;
  double by_rays = 0, by_splits = 0;
  for (const Candidate& candidate : candidates_) (candidate.splits() ? by_splits : by_rays) += told_square(candidate);
  if (by_rays < worth_rays * lasting_error_) {
    std::erase_if(candidates_, std::not_fn(&Candidate::splits));
    by_rays = 0;
  }
  if (by_rays + by_splits <= std::min(allowed, hardly_more * std::max(allowed, lasting_error_))) candidates_.clear();
}

}  // namespace alvor
