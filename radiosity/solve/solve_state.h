#pragma once
// All that a solve keeps from pass to pass.

#include "radiosity/solve/direct_field.h"
#include "radiosity/solve/forests.h"
#include "radiosity/solve/row_field.h"
#include "radiosity/solve/traced_rows.h"
#include "solution/leaf_value.h"

#include <span>
#include <vector>

namespace alvor {

/// The parts of a solve, each the owner of what its name says. A Pass makes them better; between passes they can be saved. Used
/// by one thread at a time.
class SolveState {
 public:
  /// Requires: the plan is of this mesh and these options. The mesh and the budget must outlive the state.
  SolveState(const BaseMesh& base_mesh, Plan solve_plan, SolveOptions solve_options, RayBudget& ray_budget);
  SolveState(const BaseMesh& base_mesh, const SolveOptions& solve_options, RayBudget& ray_budget)
      : SolveState(base_mesh, Plan(base_mesh, solve_options), solve_options, ray_budget) {}
  SolveState(const SolveState&) = delete;  // the parts refer to each other

  const BaseMesh& mesh;
  const Plan plan;
  const SolveOptions options;
  RayBudget& budget;
  const LocalScene scene;
  Forests forests;
  TracedRows rows;
  RowField field;
  DirectField direct;
  std::vector<Rgb> shot;  ///< by leaf node: radiosity that shots distributed so far, in emission units; 0 where light is gathered

  std::size_t leaf_count() const { return forests.leaves().leaf_count(); }
  bool may_be_lit(NodeIndex row) const { return rows.may_be_lit(row); }
  /// What rows bring to the centre of a leaf.
  Rgb indirect(NodeIndex leaf) const { return field.at(forests.row_of(leaf), forests.leaf_centres()[leaf]); }
  /// Irradiance of every leaf, W/m2, in the order of the leaf forest. Before the first exchange this is direct light alone. Never
  /// negative, and never more than where all surfaces were like the brightest.
  std::vector<LeafValue> leaf_values() const;
  /// Power that is not distributed yet while no pass exchanges light: what waits at emitters and what direct light leaves to
  /// reflect. In emission units.
  double unshot_power() const;

  /// Split a leaf of the leaf forest, or a row with the leaves below it. Rows follow leaves along contacts, where a solid's
  /// outline crosses them. Return false where the limits forbid it.
  bool split_leaf(NodeIndex leaf);
  bool split_row(NodeIndex row);
  /// To be called when a row was traced. Which points are hidden under a solid is known from rows only: along contacts leaves
  /// must not be finer than rows, and direct light that was found without that knowledge is found again.
  void heed_hidden_origins(NodeIndex row);

  static constexpr std::uint32_t saved_version = 3;  ///< 3: rows know whether they are closed
  /// Writes what it takes to go on from here with another state of the same mesh, plan and options. Only what leaves hold is
  /// written: all else is found again.
  void save(PlainWriter& out) const;
  /// Reads what save() wrote, or a server of version 2. Requires: nothing was done yet. Throws BadBytes, and is then of no use.
  void load(PlainReader& in, std::uint32_t version);

 private:
  const Rgb largest_irradiance_;  ///< that the solution can have, W/m2
  void fit_to_nodes();
  void follow_contact(NodeIndex split_leaf);
};

}  // namespace alvor
