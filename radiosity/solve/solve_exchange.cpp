// The part of a solve's state that lets light go round.

#include "radiosity/exchange/gathering.h"
#include "radiosity/solve/solve_state.h"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace alvor {

// Leaves only ever get finer, so each look-up starts where the last one ended.
void SolveState::find_hit_leaves(NodeIndex row) {
  const auto& hits = rows_[row].hits;
  auto& found = hit_leaves_[row];
  if (found.size() != hits.size()) {
    found.clear();
    for (const PatchId hit : hits) found.push_back(hit.root_face());
  }
  if (!plan_.needs(Feature::refinement)) return;
  for (std::size_t h = 0; h < hits.size(); ++h) found[h] = leaf_forest_.leaf_at(hits[h], found[h]);
}

void SolveState::begin_exchange() {
  list_patches();
  if (!has_rows()) {
    exchange_ = std::make_unique<Gathering>();
    return;
  }
  tbb::parallel_for(std::size_t{0}, patch_row_.size(), [this](std::size_t p) { find_hit_leaves(patch_row_[p]); });
  if (options_.strategy == Strategy::automatic) exchange_ = begin_gathering();
  else exchange_ = std::make_unique<ShotExchange>(begin_shooting(), options_.strategy);
}

void SolveState::list_patches() {
  patches_.clear();
  patch_leaves_.clear();
  own_radiosity_.clear();
  patch_row_ = row_forest_.leaves();
  for (const NodeIndex row : patch_row_) {
    const auto first = static_cast<std::uint32_t>(patch_leaves_.size());
    leaf_forest_.append_leaves_of(leaf_node_of_row(row), patch_leaves_);
    ShootingPatch patch{&rows_[row], first, static_cast<std::uint32_t>(patch_leaves_.size()) - first,
                        mesh_.material_of(row_forest_.id(row).root_face()).reflectance, 0};
    for (std::size_t n = first; n < patch_leaves_.size(); ++n) patch.area += leaf_area_[patch_leaves_[n]];
    patches_.push_back(patch);
  }
  for (const NodeIndex leaf : patch_leaves_) {
    const std::uint32_t root = leaf_forest_.id(leaf).root_face();
    own_radiosity_.push_back(row_emission(root) + mesh_.material_of(root).reflectance * direct_[leaf].irradiance);
  }
}

std::unique_ptr<Exchange> SolveState::begin_gathering() {
  std::vector<const NodeIndex*> hit_leaf;
  std::vector<Rgb> irradiance;
  std::vector<PatchId> ids;
  for (const NodeIndex row : patch_row_) {
    ids.push_back(row_forest_.id(row));
    hit_leaf.push_back(hit_leaves_[row].data());
    irradiance.push_back(row_irradiance_[row]);
  }
  return std::make_unique<Gathering>(patches_, patch_leaves_, leaf_forest_.node_count(), own_radiosity_, std::move(hit_leaf),
                                     std::move(irradiance), std::move(ids),
                                     GatheringNeeds{plan_.needs(Feature::three_bands), plan_.needs(Feature::acceleration)});
}

Shooting SolveState::begin_shooting() {
  std::vector<std::uint32_t> place_of(leaf_forest_.node_count()), hit_leaf;
  std::vector<ShootingLeaf> leaves;
  leaves.reserve(patch_leaves_.size());
  for (std::uint32_t n = 0; n < patch_leaves_.size(); ++n) {
    const NodeIndex leaf = patch_leaves_[n];
    place_of[leaf] = n;
    leaves.push_back({leaf_area_[leaf], own_radiosity_[n] - shot_[leaf], shot_[leaf]});
  }
  if (has_rows())
    for (const NodeIndex row : patch_row_)
      for (const NodeIndex leaf : hit_leaves_[row]) hit_leaf.push_back(place_of[leaf]);
  Shooting shooting(patches_, std::move(leaves), std::move(hit_leaf));
  shooting.find_unshot();
  return shooting;
}

Shooting SolveState::unshot_system() {
  std::ranges::fill(shot_, Rgb{});
  return begin_shooting();
}

void SolveState::show(std::span<const Rgb> irradiance) {
  for (std::size_t p = 0; p < patch_row_.size(); ++p) {
    const NodeIndex row = patch_row_[p];
    row_irradiance_[row] = irradiance[p];
    row_fit_[row] = FieldFit::constant(irradiance[p]);
  }
}

}  // namespace alvor
