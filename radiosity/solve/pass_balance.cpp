// The power balance of a pass.

#include "radiosity/exchange/parallel_sum.h"
#include "radiosity/solve/pass.h"

#include <algorithm>

namespace alvor {

namespace {

/// Light that patches take up, and that leaves them and the scene.
struct PowerSums {
  RelativeLight absorbed, lost;

  PowerSums& operator+=(const PowerSums& other) {
    absorbed += other.absorbed, lost += other.lost;
    return *this;
  }
};

}  // namespace

// Returns whether every patch that sends light has a row. Rows may be switched off for all faces, or for emitters that no light
// reaches.
bool Pass::rows_tell_what_is_lost() const {
  if (!state_.rows.carry_light()) return false;
  for (std::uint32_t root = 0; root < state_.mesh.roots().size(); ++root)
    if (!state_.plan.may_be_lit(root) && !state_.mesh.material_of(root).emission.is_zero()) return false;
  return true;
}

/// Returns the sum of the hits' weights that does not go on through panes, times the row's ray count.
Rgb Pass::taken_up(const TransportRow& row) const {
  if (!state_.plan.needs(Feature::panes)) return row.stored_weight();
  Rgb sum;
  for (std::size_t h = 0; h < row.hits.size(); ++h)
    sum += widen(row.hit_weight[h]) * (Rgb{1, 1, 1} - state_.mesh.material_of(row.hits[h].root_face()).regular_transmittance);
  return sum;
}

// The light that leaves a patch is lost in the share of directions in which its row finds no front; that of a lamp, where it
// arrives nowhere. The part of a patch on which a solid stands receives nothing, and its emission is lost. Without rows the lost
// power is taken to be what is not accounted for otherwise.
PowerBalance Pass::balance() const {
  const DirectField& direct = state_.direct;
  PowerBalance balance{.emitted = state_.in_watts(state_.emitted_power())};
  if (!exchange_) return balance;
  const auto patches = system_->patches();
  std::vector<Rgb> taken(patches.size());
  system_->deal().for_each(state_.ranks, std::span(taken), [&](std::size_t p) { taken[p] = taken_up(*patches[p].row); });
  const auto irradiance = state_.rows.carry_light() ? exchange_->irradiance() : std::vector<RelativeLight>(patches.size());
  const auto sums_of = [&](std::size_t p) {
    PowerSums sums;
    const ShootingPatch& patch = patches[p];
    const TransportRow& row = *patch.row;
    const std::uint32_t root = state_.forests.rows().id(system_->rows()[p]).root_face();
    const Rgb white{1, 1, 1}, found = row.is_hidden() ? Rgb{} : (1.0 / row.ray_count()) * taken[p];
    const Material& material = state_.mesh.material_of(root);
    const Rgb kept = white - material.regular_transmittance - material.diffuse_transmittance;
    RelativeLight through;
    if (patch.is_translucent()) through = patch.diffuse_transmittance * irradiance[patch.behind];
    const double open = row.visible_share();
    for (const NodeIndex leaf : system_->leaves_of(p)) {
      const double area = state_.forests.cover(leaf) * state_.forests.leaf_area(leaf), seen = open * area;
      const Rgb reflectance = state_.forests.reflectance(leaf);
      const RelativeLight arriving = irradiance[p] + direct[leaf].irradiance, emission = direct.emission_of(root);
      const RelativeLight leaving = emission + reflectance * irradiance[p] + through + state_.scattered_direct_light(leaf);
      sums.absorbed += seen * ((kept - reflectance) * arriving);
      sums.lost += seen * ((white - found) * leaving) + (area - seen) * emission;
    }
    return sums;
  };
  const auto sums = parallel_sum<PowerSums>(patches.size(), sums_of);
  balance.absorbed = state_.in_watts(sums.absorbed.sum());
  balance.unshot = state_.in_watts(exchange_->unshot_power());
  const double not_seen_again = std::max(0.0, balance.emitted - balance.absorbed - balance.unshot);
  balance.lost = rows_tell_what_is_lost() ? state_.in_watts(sums.lost.sum() + state_.power_lost_on_the_way()) : not_seen_again;
  return balance;
}

}  // namespace alvor
