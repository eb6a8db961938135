#pragma once
// Everything a solve knows: two forests, their rows, direct light and what was shot.

#include "meshing/leaf_gradient.h"
#include "radiosity/direct/direct_light.h"
#include "radiosity/estimate/error_estimate.h"
#include "radiosity/estimate/marking.h"
#include "radiosity/exchange/exchange.h"
#include "radiosity/exchange/irradiance_field.h"
#include "radiosity/exchange/light_by_leaf.h"
#include "radiosity/exchange/shooting.h"
#include "radiosity/rays/transport_rows.h"
#include "radiosity/solve/solver.h"

#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace alvor {

/// Direct light is sharp and indirect light smooth, so they do not share a depth: rows hang on the leaves of a coarse forest,
/// direct light on those of a finer one that contains it. One pass is: trace_new_rows, add_new_direct_light, begin_exchange,
/// sweeps of the exchange, refine.
class SolveState {
 public:
  SolveState(const BaseMesh& mesh, const Plan& plan, const SolveOptions& options, RayBudget& budget);
  SolveState(const BaseMesh& mesh, const SolveOptions& options, RayBudget& budget)
      : SolveState(mesh, Plan(mesh, options), options, budget) {}

  const std::vector<Emitter>& emitters() const { return emitters_; }
  double emitted_power() const { return emitted_power_; }
  std::size_t leaf_count() const { return leaf_forest_.leaf_count(); }

  /// Which of the rows that are not traced yet trace_new_rows() is to trace.
  enum class Rows { all, a_part };
  /// Adds the rays that refine() asked for, and traces rows that are not: all, or of many a part that is spread over the scene.
  /// Until it is done, `after_each` is called now and then, where save() may be. Returns early where the budget is out; called
  /// again, it goes on from there. Returns whether a part was traced and others are left.
  bool trace_new_rows(
      const std::function<void()>& after_each = [] {}, Rows which = Rows::all);
  /// Adds direct light to the leaves whose rows are traced, calling `after_each` as above; what leaf_values() says may then be
  /// shown.
  void add_new_direct_light(const std::function<void()>& after_each);
  /// Sets up the exchange of light; what the previous pass found carries over.
  void begin_exchange();
  /// Requires: begin_exchange before, not refined since.
  Exchange& exchange() { return *exchange_; }
  const Exchange& exchange() const { return *exchange_; }
  /// The system of the current rows as if nothing had been shot: all that is unshot is direct light on its receivers. Borrows
  /// from the state, until it is refined. Requires: begin_exchange before, indirect rows.
  Shooting unshot_system();
  /// Makes irradiance by patch what leaf_values() shows.
  void show(std::span<const Rgb> irradiance);
  void show() { show(exchange_->irradiance()); }
  /// The same, smooth from row to row, from what the rays of rows find: what a finished pass shows.
  void show_smoothly();
  /// What was shown before, moved by what each row has received since.
  void show_what_came_since();
  /// What is still unshot, summed over bands, W, whatever the stage of the pass.
  double unshot_power() const;
  /// The same, of the emitted power; 0 in the dark.
  double unshot_fraction() const { return emitted_power_ > 0 ? unshot_power() / emitted_power_ : 0; }
  /// Share of the area of faces that light may reach on which no direct light is known yet.
  double unlit_fraction() const;
  /// Display only, see Shooting::ambient_irradiance. Zero before the first shots.
  Rgb ambient_irradiance() const { return exchange_ ? emission_unit_ * exchange_->ambient_irradiance() : Rgb{}; }
  /// W/m2. All else that is asked of the state and its exchange is light and power in this unit, so that squares stay numbers
  /// however bright or dim a scene is.
  double emission_unit() const { return emission_unit_; }

  /// Irradiance of every leaf, W/m2, in the order of their ids. Before the first shots this is direct light alone. Never
  /// negative, and never more than where all surfaces were like the brightest.
  std::vector<LeafValue> leaf_values() const;
  /// Of what the current pass has distributed, in W.
  PowerBalance balance() const;
  ErrorEstimate estimate();
  /// Splits patches and adds rays where that pays most; ends the exchange. False if nothing was done: the limits forbid every
  /// split and rows are not what errs most. Requires: estimate() just before.
  bool refine();

  /// What it takes to go on from here with another state of the same mesh, plan and options. Between passes and where it is
  /// allowed.
  void save(PlainWriter& out) const;
  /// Requires: nothing was done yet. Throws BadBytes, and is then of no use.
  void load(PlainReader& in);

 private:
  void list_patches();
  std::unique_ptr<Exchange> begin_gathering();
  Shooting begin_shooting();
  void choose_emitters();
  void split_to_start();
  void fit_to_nodes();
  std::uint32_t row_of(PatchId leaf) const { return row_forest_.leaf_at(leaf); }
  bool split_leaf(NodeIndex leaf);
  bool split_row(NodeIndex row);
  void follow_contact(NodeIndex split_leaf);
  void hand_down_field(NodeIndex split_row);
  std::vector<NodeIndex> untraced_rows() const;
  bool trace(std::span<const NodeIndex> rows);
  bool add_wanted_rays(const std::function<void()>& after_each);
  std::vector<TransportRow> traced(std::span<const NodeIndex> rows, std::span<const RowSize> sizes, std::uint64_t seed);
  RowSize size_of(PatchId patch) const;
  void make_rows_exact();
  void heed_hidden_origins(NodeIndex row);
  void inherit(std::span<const NodeIndex> split);
  NodeIndex leaf_node_of_row(NodeIndex row) const;
  Rgb emission_of(std::uint32_t root) const;
  Rgb row_emission(std::uint32_t root) const;
  static Rgb largest_irradiance(const BaseMesh& mesh);
  bool rows_tell_what_is_lost() const;
  void find_hit_leaves(NodeIndex row);
  void show_on_whole_face(NodeIndex leaf);
  std::vector<NodeIndex> unlit_leaves() const;
  std::vector<Receiver> receivers_of(std::span<const NodeIndex> leaves) const;
  RowSamples samples_of(NodeIndex row, const LightByLeaf& radiosity) const;
  LightByLeaf radiosity() const;
  /// Otherwise rows are there to tell what is hidden, and no light goes along them.
  bool has_rows() const { return plan_.needs(Feature::indirect_rows); }
  RowNeeds row_needs() const { return {plan_.needs(Feature::back_sides), plan_.needs(Feature::refinement)}; }
  bool may_be_lit(NodeIndex row) const { return plan_.may_be_lit(row_forest_.id(row).root_face()); }
  bool may_split(Candidate::Kind kind, NodeIndex patch) const;
  void add_candidates(Candidate::Kind kind, std::span<const NodeIndex> patches, std::span<const double> errors, double rays);
  void estimate_rows(ErrorEstimate& error);
  double estimate_leaves(ErrorEstimate& error);
  double squared_contrast(NodeIndex leaf, const Rgb& irradiance, const LeafSlope& slope) const;
  Rgb indirect(NodeIndex leaf) const { return indirect(leaf, leaf_centre_[leaf]); }
  Rgb indirect(NodeIndex leaf, Vec3 at) const { return has_rows() ? row_fit_[row_of(leaf_forest_.id(leaf))].at(at) : Rgb{}; }

  const BaseMesh& mesh_;
  const Rgb largest_irradiance_ = largest_irradiance(mesh_);  ///< that the solution can have, W/m2
  Plan plan_;
  SolveOptions options_;
  RayBudget& budget_;
  LocalScene scene_;
  DirectionSets directions_;
  RefinementLimits limits_;
  PatchForest row_forest_, leaf_forest_;
  NeighbourTable row_neighbours_{row_forest_}, leaf_neighbours_{leaf_forest_};
  std::vector<Emitter> emitters_;
  std::unique_ptr<LightTree> light_tree_;  ///< where there are many
  std::uint64_t rounds_of_rays_ = 0;       ///< each adds independent rays
  std::vector<NodeIndex> wanting_rays_;    ///< rows that the newest round has not reached
  double area_ = 0;                        ///< of all roots, m2
  double emission_unit_ = 1;               ///< the brightest emission, W/m2
  double emitted_power_ = 0;
  double waiting_power_ = 0;  ///< of the emitters whose light was not added yet

  // By node of row_forest_.
  std::vector<TransportRow> rows_;
  std::vector<bool> row_is_traced_;
  std::vector<Rgb> row_irradiance_;
  std::vector<Vec3> row_centre_;
  std::vector<FieldFit> row_fit_;
  std::vector<std::vector<NodeIndex>> hit_leaves_;  ///< where each hit of the row was found last
  // By node of leaf_forest_.
  std::vector<DirectLight> direct_;
  std::vector<bool> direct_is_known_;
  std::vector<bool>
      is_lit_;             ///< direct_ shows some light: that of all emitters, of the first ones, or of another leaf of the face
  std::vector<Rgb> shot_;  ///< what shots distributed so far, when they are how light is exchanged
  std::vector<Vec3> leaf_centre_;
  std::vector<double> leaf_area_;

  // Of the current pass.
  std::vector<ShootingPatch> patches_;
  std::vector<NodeIndex> patch_row_;     // row node of each patch
  std::vector<NodeIndex> patch_leaves_;  // leaf nodes, patch after patch
  std::vector<Rgb> own_radiosity_;       // by place of patch_leaves_
  std::unique_ptr<Exchange> exchange_;
  std::vector<Candidate> candidates_;
};

}  // namespace alvor
