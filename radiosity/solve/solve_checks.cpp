// The part of a solve's state that knows what holds of every solution.

#include "radiosity/solve/solve_state.h"

#include <algorithm>

namespace alvor {

namespace {

constexpr double held_by_floats = 1e37;  // W/m2, with room for sums

}  // namespace

// Where every surface emitted like the brightest and reflected like the lightest, B would be this everywhere, and H no larger.
// What rays estimate may lie beyond, the truth does not.
Rgb SolveState::largest_irradiance(const BaseMesh& mesh) {
  Rgb emission, reflectance;
  for (const RootPatch& root : mesh.roots()) {
    emission = upper(emission, mesh.materials()[root.material].emission);
    reflectance = upper(reflectance, mesh.materials()[root.material].reflectance);
  }
  const Rgb most{emission.r / (1 - reflectance.r), emission.g / (1 - reflectance.g), emission.b / (1 - reflectance.b)};
  return lower(most, {held_by_floats, held_by_floats, held_by_floats});
}

// Not where they were switched off: for all faces, or for emitters that no light reaches.
bool SolveState::rows_tell_what_is_lost() const {
  if (!has_rows()) return false;
  for (std::uint32_t root = 0; root < mesh_.roots().size(); ++root)
    if (!plan_.may_be_lit(root) && !mesh_.material_of(root).emission.is_zero()) return false;
  return true;
}

// What leaves a patch is lost as far as its row does not find a front. Where a solid stands on it nothing arrives, and what it
// emits there is lost too. Where there are no rows nothing tells: what did not arrive must have been lost.
PowerBalance SolveState::balance() const {
  PowerBalance balance{.emitted = emission_unit_ * emitted_power_};
  if (!exchange_) return balance;
  const auto irradiance = has_rows() ? exchange_->irradiance() : std::vector<Rgb>(patches_.size());
  Rgb absorbed, lost;
  for (std::size_t p = 0; p < patches_.size(); ++p) {
    const ShootingPatch& patch = patches_[p];
    const TransportRow& row = *patch.row;
    const std::uint32_t root = row_forest_.id(patch_row_[p]).root_face();
    const Rgb white{1, 1, 1}, found = row.is_hidden() ? Rgb{} : (1.0 / row.ray_count()) * row.stored_weight();
    const double open = row.visible_share();
    for (std::uint32_t k = patch.first_leaf; k < patch.first_leaf + patch.leaf_count; ++k) {
      const double area = leaf_area_[patch_leaves_[k]], seen = open * area;
      const Rgb arriving = irradiance[p] + direct_[patch_leaves_[k]].irradiance, emission = emission_of(root);
      absorbed += seen * ((white - patch.reflectance) * arriving);
      lost += seen * ((white - found) * (emission + patch.reflectance * arriving)) + (area - seen) * emission;
    }
  }
  balance.absorbed = emission_unit_ * absorbed.sum();
  balance.unshot = emission_unit_ * exchange_->unshot_power();
  const double not_seen_again = std::max(0.0, balance.emitted - balance.absorbed - balance.unshot);
  balance.lost = rows_tell_what_is_lost() ? emission_unit_ * lost.sum() : not_seen_again;
  return balance;
}

}  // namespace alvor
