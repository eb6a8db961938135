#pragma once
// The state that a solve keeps from pass to pass.

#include "radiosity/direct/emission_unit.h"
#include "radiosity/solve/direct_field.h"
#include "radiosity/solve/forests.h"
#include "radiosity/solve/known_errors.h"
#include "radiosity/solve/moved_roots.h"
#include "radiosity/solve/row_field.h"
#include "radiosity/solve/seen_slivers.h"
#include "radiosity/solve/traced_rows.h"
#include "solution/leaf_value.h"

#include <bit>
#include <optional>
#include <span>
#include <vector>

namespace alvor {

/// The parts of a solve: forests, rows, direct light and the shown field, each owned by one member. A Pass improves them; between
/// passes they can be saved. It is the same on all ranks but for the hits of rows. Used by one thread at a time.
class SolveState {
 public:
  /// Requires: the plan is of this mesh and these options; with several ranks, Strategy::automatic. The mesh, the budget and the
  /// ranks must outlive the state.
  SolveState(const BaseMesh& base_mesh, Plan solve_plan, SolveOptions solve_options, RayBudget& ray_budget,
             Ranks& solving_ranks = Ranks::alone());
  SolveState(const BaseMesh& base_mesh, const SolveOptions& solve_options, RayBudget& ray_budget)
      : SolveState(base_mesh, Plan(base_mesh, solve_options), solve_options, ray_budget) {}
  SolveState(const SolveState&) = delete;  // the parts refer to each other

  const BaseMesh& mesh;
  Plan plan;
  const SolveOptions options;
  RayBudget& budget;
  Ranks& ranks;
  LocalScene scene;
  Forests forests;
  TracedRows rows;
  RowField field;
  DirectField direct;
  SeenSlivers slivers;              ///< found again from the rows; not in what save() writes
  KnownErrors known_errors;         ///< of the last estimate; not in what save() writes
  std::vector<RelativeLight> shot;  ///< by leaf node: radiosity that shots distributed so far; 0 if light is gathered

  std::size_t leaf_count() const { return forests.leaves().leaf_count(); }
  // In the functions below, `row` is forests.row_of(leaf).

  /// Returns the origins of a leaf that are hidden (TransportRow::hidden_origins), which only a row of the same place tells.
  std::uint16_t hidden_origins(NodeIndex leaf, NodeIndex row) const {
    if (rows[row].is_hidden()) return 0xffff;
    return forests.rows().id(row) == forests.leaves().id(leaf) ? rows[row].hidden_origins : std::uint16_t{0};
  }
  /// Returns the area of the part of a leaf that no solid hides, m2.
  double visible_area(NodeIndex leaf, NodeIndex row) const {
    return forests.leaf_area(leaf) * (1 - std::popcount(hidden_origins(leaf, row)) / double(origins_per_patch));
  }
  /// Returns the direct light that a leaf reflects, and that comes through from the leaf behind it.
  RelativeLight scattered_direct_light(NodeIndex leaf) const {
    const RelativeLight reflected = forests.reflectance(leaf) * direct[leaf].irradiance;
    const NodeIndex behind = forests.leaf_behind(leaf);
    if (behind == PatchForest::no_node) return reflected;
    return reflected + forests.material_of(leaf).diffuse_transmittance * direct[behind].irradiance;
  }
  /// Returns the irradiance that rows bring to the centre of a leaf.
  RelativeLight indirect(NodeIndex leaf, NodeIndex row) const { return field.at(row, forests.leaf_centres()[leaf]); }
  /// Returns the irradiance of every leaf, W/m2, in the order of the leaf forest. Before the first exchange this is direct light
  /// alone. Values are never negative, and never more than if all surfaces emitted and reflected like the brightest. `irradiance`
  /// is what would be found, direct and indirect, in emission units and the order of the leaves, if it is known.
  std::vector<LeafValue> leaf_values(std::span<const RelativeLight> irradiance = {}) const;
  /// Returns the power that the scene emits, and what of that of lamps is lost on the way: see DirectField.
  double emitted_power() const {
    return direct.emitted_power([this] { return arrived_power(); });
  }
  double power_lost_on_the_way() const {
    return direct.power_lost_on_the_way([this] { return arrived_power(); });
  }
  /// Loads what is known of the leaf that comes Forests::leaves_ahead places after `leaves[n]`.
  void fetch_ahead(std::span<const NodeIndex> leaves, std::size_t n) const;
  /// Returns light in W/m2, such as an ambient irradiance that is displayed with leaf_values().
  Rgb in_watts_per_m2(const RelativeLight& light) const { return unit_.to_watts_per_m2(light); }
  /// Returns W for a power in emission units times m2.
  double in_watts(double power) const { return unit_.to_watts(power); }
  /// Returns the power that is not distributed yet if no exchange has begun: the emitters' waiting power and the scattered direct
  /// light. Summed over bands, in emission units times m2.
  double unshot_power() const;

  /// Splits a leaf of the leaf forest as `wanted`, or into quarters where slabs are not allowed. Also splits the row of the same
  /// place, if there is one and it is not traced or a solid's outline crosses it. Returns true if the leaf is split now, false if
  /// the limits forbid it.
  bool split_leaf(NodeIndex leaf, Split wanted = Split::quarters);
  /// Splits a row as the leaf of its place is split; before, splits that as `wanted` if it is not split. Returns true if the row
  /// is split now, false if the limits forbid it.
  bool split_row(NodeIndex row, Split wanted = Split::quarters);
  /// Uses the hidden origins that tracing found for a row; to be called when it was traced. Direct light of the row's leaves is
  /// found again without hidden points. A row that a solid's outline crosses is split as its leaves are, because only rows know
  /// which points are hidden.
  void heed_hidden_origins(NodeIndex row);

  /// Takes the materials and lights of the mesh, which have changed, with a plan of the mesh as it is now. What is not known any
  /// more is found by the next pass. `reflects_as_before` says that only emission and lights have changed: where all of them have
  /// by one factor, indirect light has, too. Returns the factor by which all light was multiplied, if nothing else has changed.
  /// Requires: rows and forests are those of the mesh as it is now.
  std::optional<double> note_relit(Plan new_plan, bool reflects_as_before);

  /// Notes how much direct light is scattered, before materials and lights of the mesh change. What was noted before an earlier
  /// edit, whose direct light is not found yet, stays.
  void note_scattered_light();
  /// Multiplies the field, per band, by the ratio of the scattered direct light of the whole scene to what was noted last, if it
  /// is between 1/2 and 2: the exchange then has less to change. To be called when direct light is known.
  void scale_field_to_direct_light();

  /// Takes roots that the mesh has got at its end since it had `roots_before`, all of them hidden. To be followed by note_relit()
  /// or note_moved(). Requires: one rank.
  void note_appended(std::size_t roots_before);

  /// Takes roots of the mesh that have moved since it was `before`, and materials and lights as note_relit() does. leaf_values()
  /// then has the light of before; mend_moved() must be called before a pass begins. Requires: one rank; no frame, neighbour or
  /// twin has changed.
  void note_moved(BaseMesh before, Plan new_plan, bool reflects_as_before);
  /// Returns whether roots have moved that mend_moved() has not heeded.
  bool has_unmended_move() const { return move_.has_value(); }
  /// Mends rows and forgets direct light that the moved roots were or are in the way of. Requires: has_unmended_move().
  void mend_moved();

  /// Lets the next estimate find the errors of rows again, because their field was replaced or their hits change.
  void forget_errors(std::span<const NodeIndex> of_rows);

  /// Collective. Writes the values of leaves and rows, from which another state of this mesh, plan and options can go on, with
  /// any number of ranks; all else is computed again.
  void save(PlainWriter& out) const;
  /// Reads what save() wrote in a checkpoint of `version`, see solve_control.h. Throws BadBytes; the state must not be used after
  /// that. Requires: no row was traced and nothing split since construction.
  void load(PlainReader& in, std::uint32_t version);

 private:
  struct Move {
    BaseMesh before;
    MovedRoots roots;
  };
  std::optional<Move> move_;  ///< that rows and direct light do not heed yet
  EmissionUnit unit_{mesh};
  std::optional<RelativeLight> scattered_before_;  ///< see note_scattered_light(); nothing where no edit is pending
  Rgb largest_irradiance_;                         ///< upper bound on the irradiance of the solution, W/m2
  void fit_to_nodes();
  std::optional<double> relight(Plan new_plan, bool reflects_as_before);
  double arrived_power() const;
  RelativeLight scattered_power() const;
  std::vector<std::uint8_t> rows_in_sight(const MovedRoots& moved);
  void follow_contact(NodeIndex split_leaf);
  /// Splits the row in the place of a leaf that was split into slabs, if it is larger and sees near surfaces: where direct light
  /// changes across a line because of these, reflected light does, too, and the few origins of a large row seldom lie there.
  void follow_slabs(NodeIndex split_leaf);
  bool sees_near_surfaces(NodeIndex row);
};

}  // namespace alvor
