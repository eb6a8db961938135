#include "radiosity/solve/pass_system.h"

#include "radiosity/exchange/gathering.h"
#include "radiosity/exchange/strategies.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cassert>

namespace alvor {

PassSystem::PassSystem(SolveState& state, const std::function<bool()>& gives_up)
    : state_(state),
      rows_(state.forests.all_rows()),
      leaves_(state.forests.all_leaves()),
      deal_(state.rows.deal(rows_)),
      patches_(rows_.size()) {
  deal_leaves();
  if (state.mesh.has_varying_reflectance()) leaf_reflectance_.resize(leaves_.size());
  tbb::parallel_for(std::size_t{0}, patches_.size(), [this](std::size_t p) { describe_patch(p); });
  find_patches_behind();
  describe_places();
  if (state.rows.carry_light()) state.rows.find_hit_leaves(rows_, deal_, gives_up);
}

/// Gives each patch its leaves. Rows and leaves are both sorted by id, and each leaf lies within a row.
void PassSystem::deal_leaves() {
  const PatchForest &rows = state_.forests.rows(), &leaves = state_.forests.leaves();
  std::uint32_t next = 0;
  for (std::size_t p = 0; p < patches_.size(); ++p) {
    patches_[p].first_leaf = next;
    while (next < leaves_.size() && rows.id(rows_[p]).contains(leaves.id(leaves_[next]))) ++next;
    patches_[p].leaf_count = next - patches_[p].first_leaf;
  }
  assert(next == leaves_.size());
}

void PassSystem::describe_patch(std::size_t p) {
  const Forests& forests = state_.forests;
  ShootingPatch& patch = patches_[p];
  patch.row = &state_.rows[rows_[p]];
  patch.reflectance = state_.mesh.material_of(forests.rows().id(rows_[p]).root_face()).reflectance;
  Rgb reflecting;
  double covered = 0;
  for (std::size_t n = patch.first_leaf; n < patch.first_leaf + patch.leaf_count; ++n) {
    const double area = forests.leaf_area(leaves_[n]);
    patch.area += area;
    if (leaf_reflectance_.empty()) continue;
    leaf_reflectance_[n] = forests.reflectance(leaves_[n]);
    reflecting += area * forests.cover(leaves_[n]) * leaf_reflectance_[n];
    covered += area * forests.cover(leaves_[n]);
  }
  if (covered > 0) patch.reflectance = (1 / covered) * reflecting;
}

void PassSystem::describe_places() {
  patch_of_place_.resize(leaves_.size());
  visible_area_.resize(leaves_.size());
  own_radiosity_.resize(leaves_.size());
  tbb::parallel_for(std::size_t{0}, patches_.size(), [this](std::size_t p) {
    const RelativeLight emission = state_.direct.emission_by_rows(state_.forests.rows().id(rows_[p]).root_face());
    for (std::size_t n = patches_[p].first_leaf; n < patches_[p].first_leaf + patches_[p].leaf_count; ++n) {
      state_.fetch_ahead(leaves_, n);
      patch_of_place_[n] = static_cast<std::uint32_t>(p);
      visible_area_[n] = state_.visible_area(leaves_[n], rows_[p]);
      own_radiosity_[n] = emission + state_.scattered_direct_light(leaves_[n]);
    }
  });
}

void PassSystem::find_patches_behind() {
  const Forests& forests = state_.forests;
  if (std::ranges::none_of(state_.mesh.materials(), &Material::is_translucent)) return;
  std::vector<std::uint32_t> patch_of_row(forests.rows().node_count());
  for (std::uint32_t p = 0; p < rows_.size(); ++p) patch_of_row[rows_[p]] = p;
  for (std::size_t p = 0; p < rows_.size(); ++p) {
    const NodeIndex behind = forests.rows().leaf_behind(rows_[p]);
    if (behind == PatchForest::no_node) continue;
    patches_[p].behind = patch_of_row[behind];
    patches_[p].diffuse_transmittance = state_.mesh.material_of(forests.rows().id(rows_[p]).root_face()).diffuse_transmittance;
  }
}

std::unique_ptr<Exchange> PassSystem::begin_exchange() const {
  if (!state_.rows.carry_light()) return std::make_unique<Gathering>();
  if (state_.options.strategy == Strategy::automatic) return begin_gathering();
  return std::make_unique<ShotExchange>(shooting(), state_.options.strategy);
}

std::unique_ptr<Exchange> PassSystem::begin_gathering() const {
  std::vector<const NodeIndex*> hit_leaf(rows_.size());
  std::vector<RelativeLight> irradiance(rows_.size());
  std::vector<PatchId> ids(rows_.size());
  tbb::parallel_for(std::size_t{0}, rows_.size(), [&](std::size_t p) {
    ids[p] = state_.forests.rows().id(rows_[p]);
    hit_leaf[p] = state_.rows.leaves_hit(rows_[p]).data();
    irradiance[p] = state_.field.irradiance(rows_[p]);
  });
  return std::make_unique<Gathering>(
      patches_, leaves_, state_.forests.leaves().node_count(), own_radiosity_, std::move(hit_leaf), std::move(irradiance),
      std::move(ids), GatheringNeeds{state_.plan.needs(Feature::three_bands), state_.plan.needs(Feature::acceleration)},
      leaf_reflectance_, GatheringRanks{state_.ranks, deal_});
}

Shooting PassSystem::shooting() const {
  std::vector<std::uint32_t> place_of(state_.forests.leaves().node_count()), hit_leaf;
  std::vector<ShootingLeaf> leaves;
  leaves.reserve(leaves_.size());
  for (std::uint32_t n = 0; n < leaves_.size(); ++n) {
    const NodeIndex leaf = leaves_[n];
    place_of[leaf] = n;
    leaves.push_back({state_.forests.leaf_area(leaf), own_radiosity_[n] - state_.shot[leaf], state_.shot[leaf]});
  }
  if (state_.rows.carry_light())
    for (const NodeIndex row : rows_)
      for (const NodeIndex leaf : state_.rows.leaves_hit(row)) hit_leaf.push_back(place_of[leaf]);
  Shooting shooting(patches_, std::move(leaves), std::move(hit_leaf), leaf_reflectance_);
  shooting.find_unshot();
  return shooting;
}

LightByLeaf PassSystem::radiosity() const {
  LightByLeaf radiosity(state_.forests.leaves().node_count(), state_.plan.needs(Feature::three_bands));
  tbb::parallel_for(std::size_t{0}, patches_.size(), [&](std::size_t p) {
    const RelativeLight irradiance = state_.field.irradiance(rows_[p]);
    RelativeLight through;
    if (patches_[p].is_translucent())
      through = patches_[p].diffuse_transmittance * state_.field.irradiance(rows_[patches_[p].behind]);
    for (std::uint32_t k = patches_[p].first_leaf; k < patches_[p].first_leaf + patches_[p].leaf_count; ++k)
      radiosity.set(leaves_[k], own_radiosity_[k] + state_.forests.reflectance(leaves_[k]) * irradiance + through);
  });
  return radiosity;
}

}  // namespace alvor
