#pragma once
// The linear system of one pass, made of rows, leaves and direct light as they stand.

#include "radiosity/exchange/light_by_leaf.h"
#include "radiosity/exchange/shooting.h"
#include "radiosity/solve/solve_state.h"

#include <memory>
#include <span>
#include <vector>

namespace alvor {

/// Patches are the leaves of the row forest, in their order; leaves are listed patch after patch, and a leaf's place is its index
/// in that list. Light is in emission units. Borrows the state, which must not be refined meanwhile.
class PassSystem {
 public:
  explicit PassSystem(SolveState& state);
  PassSystem(const PassSystem&) = delete;  // exchanges borrow its lists

  std::span<const ShootingPatch> patches() const { return patches_; }
  std::span<const NodeIndex> rows() const { return rows_; }      ///< row node of each patch
  std::span<const NodeIndex> leaves() const { return leaves_; }  ///< leaf node by place
  std::span<const NodeIndex> leaves_of(std::size_t patch) const {
    return leaves().subspan(patches_[patch].first_leaf, patches_[patch].leaf_count);
  }

  /// Starts an exchange of light by the strategy of the options; where no light goes along rows there is nothing to exchange.
  std::unique_ptr<Exchange> begin_exchange() const;
  /// The system as the shots recorded in the state have left it.
  Shooting shooting() const;
  /// Radiosity of each leaf node: emitted, and reflected of direct light and of what its row received (SolveState::field).
  LightByLeaf radiosity() const;

 private:
  std::unique_ptr<Exchange> begin_gathering() const;

  SolveState& state_;
  std::vector<ShootingPatch> patches_;
  std::vector<NodeIndex> rows_, leaves_;
  std::vector<Rgb> own_radiosity_;  ///< by place: emitted, and reflected of direct light
};

}  // namespace alvor
