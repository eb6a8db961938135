#pragma once
// What a scene needs of the solver, decided before anything is spent on it.

#include "meshing/base_mesh.h"
#include "radiosity/plan/solve_options.h"

#include <cstdint>
#include <span>
#include <vector>

namespace alvor {

/// Each feature on or off, and why. A feature is off only where the answer is the same without it; SolveOptions::forced_on keeps
/// it on all the same. Takes time in proportion to the scene: no pairs of faces are looked at. Immutable.
class Plan {
 public:
  Plan(const BaseMesh& mesh, const SolveOptions& options);

  bool needs(Feature feature) const { return features_[static_cast<std::size_t>(feature)].is_on; }
  /// In the order of all_features.
  std::span<const PlannedFeature> features() const { return features_; }

  /// Something emits.
  bool has_light() const { return has_light_; }
  /// Most surfaces emit, as in a furnace: rows, whose sums are exact, carry emission too, and no shadow rays are sent.
  bool emission_by_rows() const { return emission_by_rows_; }
  /// Some lit point is behind a face: without that nothing can be hidden under a solid.
  bool backs_are_seen() const { return backs_are_seen_; }
  /// False only for roots whose fronts no light can reach, where that is made use of.
  bool may_be_lit(std::uint32_t root) const { return is_dark_.empty() || !is_dark_[root]; }

 private:
  std::vector<PlannedFeature> features_;
  std::vector<bool> is_dark_;  // by root; empty: none
  bool has_light_ = false, emission_by_rows_ = false, backs_are_seen_ = false;
};

}  // namespace alvor
