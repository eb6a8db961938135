#pragma once
// The errors of single rows and leaves that an estimate of a solve found, kept for its next estimate.

#include "radiosity/solve/forests.h"

#include <span>
#include <vector>

namespace alvor {

/// The error of a patch that splitting it would remove, squared and integrated over it, in emission units squared times m2, and
/// the split that follows it best.
struct SplitError {
  double square = 0;
  Split split = Split::quarters;
};

/// By how much the irradiance at the origins of a row differs from the field that is shown, and what they do not see.
struct OriginMisfit {
  double square = 0;  ///< mean square difference over the strata, less their noise; may be negative; emission units squared
  double noise = 0;   ///< variance of a stratum's value, mean over them
  SplitError unseen;  ///< of places that its origins do not see
  Split split = Split::quarters;    ///< the split that follows the difference best
  bool has_several_rounds = false;  ///< most strata have several rounds of rays, and their noise is found from how these differ
};

/// The errors of the last estimate, 56 bytes for each node of the row forest and 32 of the leaf forest. After an edit that leaves
/// most of a scene as it was, only those are found again whose light has changed. Empty unless they are kept.
class KnownErrors {
 public:
  /// An error, and the irradiance that it was found at, mean over bands, emission units.
  template <class Error>
  struct Known {
    Error error;
    double irradiance = 0;
    bool is_known = false;
  };

  /// Lets errors be kept from now on.
  void keep() { are_kept_ = true; }
  void clear() { rows_ = {}, leaves_ = {}; }
  /// Makes room for errors of these forests, none of them known, if errors are kept.
  void make_room(const Forests& forests) {
    if (!are_kept_) return;
    rows_.assign(forests.rows().node_count(), {});
    leaves_.assign(forests.leaves().node_count(), {});
  }
  /// Makes room for new nodes, whose errors are not known, unless it is empty.
  void fit_to_nodes(const Forests& forests) {
    if (empty()) return;
    rows_.resize(forests.rows().node_count());
    leaves_.resize(forests.leaves().node_count());
  }
  bool empty() const { return leaves_.empty(); }

  // Requires: not empty; nodes of the forests that the errors are of.
  const Known<OriginMisfit>& of_row(NodeIndex row) const { return rows_[row]; }
  const Known<SplitError>& of_leaf(NodeIndex leaf) const { return leaves_[leaf]; }
  void set_row(NodeIndex row, const OriginMisfit& error, double irradiance) { rows_[row] = {error, irradiance, true}; }
  void set_leaf(NodeIndex leaf, const SplitError& error, double irradiance) { leaves_[leaf] = {error, irradiance, true}; }
  /// Notes light that came since the errors were found, and that is no reason to find them again. `light` is the irradiance that
  /// a row and its leaves got, mean over bands, emission units.
  void add_light(NodeIndex row, std::span<const NodeIndex> leaves, double light) {
    rows_[row].irradiance += light;
    for (const NodeIndex leaf : leaves) leaves_[leaf].irradiance += light;
  }
  void forget_row(NodeIndex row) { rows_[row].is_known = false; }
  void forget_leaf(NodeIndex leaf) { leaves_[leaf].is_known = false; }

 private:
  bool are_kept_ = false;
  std::vector<Known<OriginMisfit>> rows_;
  std::vector<Known<SplitError>> leaves_;
};

}  // namespace alvor
