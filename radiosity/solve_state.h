#pragma once
// Everything a solve knows: two forests, their rows, direct light and what was shot.

#include "meshing/leaf_gradient.h"
#include "radiosity/direct_light.h"
#include "radiosity/error_estimate.h"
#include "radiosity/marking.h"
#include "radiosity/shooting.h"
#include "radiosity/solver.h"
#include "radiosity/transport_rows.h"

#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace alvor {

/// Direct light is sharp and indirect light smooth, so they do not share a depth: rows hang on the leaves of a coarse forest,
/// direct light on those of a finer one that contains it. One pass is: trace_new_rows, add_new_direct_light, begin_shooting,
/// shots, refine.
class SolveState {
 public:
  SolveState(const BaseMesh& mesh, const SolveOptions& options, RayBudget& budget);

  const std::vector<Emitter>& emitters() const { return emitters_; }
  double emitted_power() const { return emitted_power_; }
  std::size_t leaf_count() const { return leaf_forest_.leaf_count(); }

  void trace_new_rows();
  /// `after_each` is called when an emitter's light is complete.
  void add_new_direct_light(const std::function<void()>& after_each);
  /// Sets up the transpose and the residual; the state of the previous pass carries over.
  void begin_shooting();
  /// The same as if nothing had been shot: all that is unshot is direct light on its receivers.
  void restart_shooting();
  Shooting& shooting() { return *shooting_; }
  const Shooting& shooting() const { return *shooting_; }
  /// Reads the irradiance by rows back, so that leaf_values() and estimate() see it.
  void take_irradiance();
  /// The same, with slopes from row to row: what a finished pass shows.
  void take_smooth_irradiance();
  /// What is still unshot, summed over bands, W, whatever the stage of the pass.
  double unshot_power() const;
  /// The same, of the emitted power; 0 in the dark.
  double unshot_fraction() const { return emitted_power_ > 0 ? unshot_power() / emitted_power_ : 0; }
  /// Display only, see Shooting::ambient_irradiance. Zero before the first shots.
  Rgb ambient_irradiance() const { return shooting_ ? shooting_->ambient_irradiance() : Rgb{}; }

  /// Irradiance of every leaf. Before the first shots this is direct light alone.
  std::vector<LeafValue> leaf_values() const;
  ErrorEstimate estimate();
  /// Splits patches and adds rays where that pays most; ends the shooting. False if nothing was done: the limits forbid every
  /// split and rows are not what errs most. Requires: estimate() just before.
  bool refine();

 private:
  void choose_emitters();
  void split_to_start();
  void fit_to_nodes();
  std::uint32_t row_of(PatchId leaf) const { return row_forest_.leaf_at(leaf); }
  bool split_leaf(NodeIndex leaf);
  bool split_row(NodeIndex row);
  void follow_contact(NodeIndex split_leaf);
  std::vector<NodeIndex> trace_untraced();
  void make_rows_exact();
  void heed_hidden_origins(NodeIndex row);
  void inherit(std::span<const NodeIndex> split);
  void collect_leaves(NodeIndex node, std::vector<NodeIndex>& leaves) const;
  NodeIndex leaf_node_of_row(NodeIndex row) const;
  Rgb row_emission(std::uint32_t root) const;
  bool add_rays(std::span<const NodeIndex> rows);
  const std::vector<NodeIndex>& find_hit_leaves(NodeIndex row);
  std::vector<double> row_variances() const;
  bool may_split(Candidate::Kind kind, NodeIndex patch) const;
  void add_candidates(Candidate::Kind kind, std::span<const NodeIndex> patches, std::span<const double> errors, double rays);
  double estimate_rows(ErrorEstimate& error);
  double estimate_leaves(ErrorEstimate& error);

  const BaseMesh& mesh_;
  SolveOptions options_;
  RayBudget& budget_;
  LocalScene scene_;
  DirectionSets directions_;
  RefinementLimits limits_;
  PatchForest row_forest_, leaf_forest_;
  std::vector<Emitter> emitters_;
  bool emission_by_rows_ = false;
  std::uint64_t rounds_of_rays_ = 0;  ///< each adds independent rays
  double emitted_power_ = 0;
  double waiting_power_ = 0;  ///< of the emitters whose light was not added yet

  // By node of row_forest_.
  std::vector<TransportRow> rows_;
  std::vector<bool> row_is_traced_;
  std::vector<Rgb> row_irradiance_;
  std::vector<Vec3> row_centre_;
  std::vector<LeafSlope> row_slope_;
  std::vector<std::vector<NodeIndex>> hit_leaves_;  ///< where each hit of the row was found last
  // By node of leaf_forest_.
  std::vector<DirectLight> direct_;
  std::vector<bool> direct_is_known_;
  std::vector<Rgb> shot_;
  std::vector<Vec3> leaf_centre_;
  std::vector<double> leaf_area_;

  // Of the current pass.
  std::vector<ShootingPatch> patches_;
  std::vector<NodeIndex> patch_row_;              // row node of each patch
  std::vector<NodeIndex> patch_leaves_;           // leaf nodes, patch after patch
  std::vector<SmoothNeighbours> row_neighbours_;  // by patch; empty until needed
  std::unique_ptr<Shooting> shooting_;
  std::vector<Candidate> candidates_;
};

}  // namespace alvor
