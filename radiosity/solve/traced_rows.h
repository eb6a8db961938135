#pragma once
// The transport rows of a solve: which are traced, which are to get more rays, and which leaves their hits find.

#include "radiosity/plan/plan.h"
#include "radiosity/rays/transport_rows.h"
#include "radiosity/solve/forests.h"

#include <functional>
#include <span>
#include <vector>

namespace alvor {

/// One row for each leaf of the row forest; spans and indices are by row node. Borrows all that it is made with. Used by one
/// thread at a time.
class TracedRows {
 public:
  TracedRows(const Forests& forests, const Plan& plan, const SolveOptions& options, const LocalScene& scene, RayBudget& budget);

  const TransportRow& operator[](NodeIndex row) const { return rows_[row]; }
  bool is_traced(NodeIndex row) const { return is_traced_[row]; }
  /// The leaf nodes that the row's hits found, hit by hit, when find_hit_leaves was called last.
  std::span<const NodeIndex> leaves_hit(NodeIndex row) const { return hit_leaves_[row]; }

  /// Light goes along rows. Otherwise they are there to tell what is hidden, and hold no hits.
  bool carry_light() const { return plan_.needs(Feature::indirect_rows); }
  bool may_be_lit(NodeIndex row) const { return plan_.may_be_lit(forests_.rows().id(row).root_face()); }
  /// Rows of the row forest's leaves that light may reach and that are not traced.
  std::vector<NodeIndex> untraced() const;

  /// Traces the rows that are still leaves. Returns false, and changes nothing, where the ray budget ran out.
  bool trace(std::span<const NodeIndex> rows);
  /// Replaces the hits of all rows by exact form factors between patches (FormFactorMethod::analytic). What rays found out about
  /// hidden origins and closure stays.
  void make_exact();

  /// Asks for another round of rays for these rows.
  void want_rays(std::span<const NodeIndex> rows);
  bool want_any() const { return !wanting_.empty(); }
  /// Adds the rays that were asked for to some of the rows. Returns false, and changes nothing, where the ray budget ran out.
  bool add_wanted_rays();

  /// Finds which leaves the hits of the row lie on now. Different rows may be looked at from different threads.
  void find_hit_leaves(NodeIndex row);

  /// Makes room for new nodes of the row forest.
  void fit_to_nodes();
  /// Forgets the row of a node that was split.
  void forget(NodeIndex row);

  void save_rows(PlainWriter& out) const;
  void save_wanted(PlainWriter& out) const;
  /// Throw BadBytes. `version` is that of the checkpoint.
  void load_rows(PlainReader& in, std::uint32_t version);
  void load_wanted(PlainReader& in);

  static constexpr std::size_t rows_per_batch = 8192;  // between which a solve can be interrupted and go on later

 private:
  std::vector<TransportRow> traced(std::span<const NodeIndex> rows, std::span<const RowSize> sizes, std::uint64_t seed);
  RowSize size_of(PatchId patch) const;

  const Forests& forests_;
  const Plan& plan_;
  const SolveOptions& options_;
  const LocalScene& scene_;
  RayBudget& budget_;
  DirectionSets directions_;
  std::vector<TransportRow> rows_;
  std::vector<bool> is_traced_;
  std::vector<std::vector<NodeIndex>> hit_leaves_;
  std::uint64_t rounds_of_rays_ = 0;  ///< each adds independent rays
  std::vector<NodeIndex> wanting_;    ///< rows that the newest round has not reached
};

}  // namespace alvor
