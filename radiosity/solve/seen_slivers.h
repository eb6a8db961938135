#pragma once
// Finds slivers: visible parts of patches whose sixteen origins all lie under solids, by the rays of other rows that end there.

#include "radiosity/solve/traced_rows.h"

#include <cstdint>
#include <span>
#include <vector>

namespace alvor {

/// The rows of which rays end on hidden patches, whose origins all lie under solids: a sliver of such a patch can be seen, such
/// as the floor of a slot between two cupboards. Rows are looked at again only where their rays have changed, or may end on a
/// patch that was not hidden before. Used by one thread at a time.
class SeenSlivers {
 public:
  /// A row that sees such a patch. Of its n rays, k end there.
  struct View {
    NodeIndex row, hidden;  ///< row nodes
    double squared_share;   ///< estimate of (k/n)^2, see find()
  };

  /// Returns the views of this rank's rows, in the order of the rows. Requires: TracedRows::find_hit_leaves() was called since
  /// rows were traced; both are always those of one solve.
  std::span<const View> find(const Forests& forests, const TracedRows& rows);

 private:
  /// The weights of a row's rays that end on one patch, and of their squares.
  struct Seen {
    NodeIndex hidden;
    double weight, squared_weight;
  };
  class HiddenLeaves;
  static std::vector<Seen> seen_by(const TransportRow& row, std::span<const NodeIndex> leaves, const HiddenLeaves& hidden);
  void look_again(const Forests& forests, const TracedRows& rows, const HiddenLeaves& hidden);

  std::uint64_t changes_ = 0;            ///< TracedRows::changes() at the last find()
  std::vector<std::vector<Seen>> seen_;  ///< by row node
  std::vector<bool> is_hidden_;          ///< by row node, at the last find()
  std::vector<View> views_;
};

}  // namespace alvor
