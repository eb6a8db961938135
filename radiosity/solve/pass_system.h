#pragma once
// Makes the linear system of one pass from the rows, leaves and direct light of the state.

#include "radiosity/exchange/light_by_leaf.h"
#include "radiosity/exchange/shooting.h"
#include "radiosity/solve/solve_state.h"

#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace alvor {

/// The linear system of a pass. Patches are the leaves of the row forest, in their order. Leaves are listed patch after patch; a
/// leaf's place is its index in that list. Borrows the state, which must not be refined meanwhile.
class PassSystem {
 public:
  /// If `gives_up` returns true, the leaves of hits are not all found, and the system must not be used. Asked from any thread.
  PassSystem(SolveState& state, const std::function<bool()>& gives_up);
  PassSystem(const PassSystem&) = delete;  // exchanges borrow its lists

  std::span<const ShootingPatch> patches() const { return patches_; }
  std::span<const NodeIndex> rows() const { return rows_; }      ///< row node of each patch
  std::span<const NodeIndex> leaves() const { return leaves_; }  ///< leaf node by place
  std::span<const NodeIndex> leaves_of(std::size_t patch) const {
    return leaves().subspan(patches_[patch].first_leaf, patches_[patch].leaf_count);
  }

  NodeIndex row_of(std::size_t place) const { return rows_[patch_of_place_[place]]; }
  /// Returns the area of the part of the leaf at a place that no solid hides, m2.
  double visible_area(std::size_t place) const { return visible_area_[place]; }

  /// Returns which rank has the hits of each patch's row.
  const Deal& deal() const { return deal_; }

  /// Collective. Returns an exchange of light by the strategy of the options. If rows carry no light it has no patches.
  std::unique_ptr<Exchange> begin_exchange() const;
  /// Returns the system with the shots that are recorded in the state (SolveState::shot).
  Shooting shooting() const;
  /// Returns the radiosity of each leaf node that rows carry: emission (see DirectField::emission_by_rows), and what is reflected
  /// and let through of direct light and of the irradiance that its row received (SolveState::field).
  LightByLeaf radiosity() const;

 private:
  std::unique_ptr<Exchange> begin_gathering() const;
  void deal_leaves();
  void describe_patch(std::size_t patch);
  void find_patches_behind();
  void describe_places();

  SolveState& state_;
  std::vector<NodeIndex> rows_, leaves_;
  Deal deal_;
  std::vector<ShootingPatch> patches_;
  std::vector<std::uint32_t> patch_of_place_;
  std::vector<double> visible_area_;          ///< by place
  std::vector<RelativeLight> own_radiosity_;  ///< by place: emission that rows carry, and scattered direct light
  std::vector<Rgb> leaf_reflectance_;         ///< by place; none if no reflectance varies
};

}  // namespace alvor
