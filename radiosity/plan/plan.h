#pragma once
// Decides, before a solve, which features of the solver a scene needs.

#include "meshing/base_mesh.h"
#include "radiosity/plan/solve_options.h"

#include <cstdint>
#include <span>
#include <vector>

namespace alvor {

/// Which features of the solver are on or off for a scene, and why. A feature is off only if the answer is the same without it;
/// SolveOptions::forced_on keeps it on. Takes time in proportion to the scene: no pairs of faces are looked at. Immutable.
class Plan {
 public:
  Plan(const BaseMesh& mesh, const SolveOptions& options);

  bool needs(Feature feature) const { return features_[static_cast<std::size_t>(feature)].is_on; }
  /// Returns all features, in the order of all_features.
  std::span<const PlannedFeature> features() const { return features_; }

  /// Returns whether any face emits.
  bool has_light() const { return has_light_; }
  /// Returns whether rows carry emission too and no shadow rays are sent: more than half of all area emits, as in a furnace, and
  /// the sums of rows are exact.
  bool emission_by_rows() const { return emission_by_rows_; }
  /// Returns whether a lit point lies behind a face. If not, nothing can be hidden under a solid.
  bool backs_are_seen() const { return backs_are_seen_; }
  /// Returns whether light may reach the front of a root. If Feature::dark_faces is on, it may reach all that are not hidden.
  bool may_be_lit(std::uint32_t root) const { return is_dark_.empty() || !is_dark_[root]; }

 private:
  std::vector<PlannedFeature> features_;
  std::vector<bool> is_dark_;  // by root; empty: no root is dark
  bool has_light_ = false, emission_by_rows_ = false, backs_are_seen_ = false;
};

}  // namespace alvor
