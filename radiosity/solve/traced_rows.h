#pragma once
// The transport rows of a solve: traced rows, rows that want more rays, and the leaves that hits find.

#include "radiosity/plan/plan.h"
#include "radiosity/ranks/deal.h"
#include "radiosity/rays/transport_rows.h"
#include "radiosity/solve/forests.h"
#include "radiosity/solve/hit_boxes.h"
#include "radiosity/solve/moved_roots.h"

#include <functional>
#include <map>
#include <optional>
#include <span>
#include <vector>

namespace alvor {

/// Rows of which rays were sent again after a move, and those that must be traced anew. Row nodes.
struct MendedRows {
  std::vector<NodeIndex> mended, lost;
};

/// The transport rows of the row forest's leaves. Indices are row nodes. Each row's hits are on the rank that traced it
/// (is_own()); all else of the row is on all ranks. Borrows all that it is made with. Used by one thread at a time.
class TracedRows {
 public:
  TracedRows(const Forests& forests, const Plan& plan, const SolveOptions& options, const LocalScene& scene, RayBudget& budget,
             Ranks& ranks);

  const TransportRow& operator[](NodeIndex row) const { return rows_[row]; }
  bool is_traced(NodeIndex row) const { return is_traced_[row]; }
  /// Returns the rank that traces the row and has its hits.
  std::size_t rank_of(NodeIndex row) const {
    return ranks_.first_worker() + worker_of(forests_.rows().id(row), ranks_.workers());
  }
  bool is_own(NodeIndex row) const { return ranks_.is_alone() || rank_of(row) == ranks_.rank(); }
  /// Deals rows to the ranks that have them.
  Deal deal(std::span<const NodeIndex> rows) const;
  /// Returns the leaf node that each hit of a row of this rank found when find_hit_leaves() was called last.
  std::span<const NodeIndex> leaves_hit(NodeIndex row) const { return hit_leaves_[row]; }

  /// Returns whether light goes along rows. If not, rows only tell which origins are hidden, and hold no hits.
  bool carry_light() const { return plan_.needs(Feature::indirect_rows); }
  bool may_be_lit(NodeIndex row) const { return plan_.may_be_lit(forests_.rows().id(row).root_face()); }
  /// Returns the leaves of the row forest that light may reach and whose rows are not traced.
  std::vector<NodeIndex> untraced() const;

  /// Collective. Traces the rows. Returns false, and changes nothing, if the ray budget ran out. Requires: leaves of the row
  /// forest.
  bool trace(std::span<const NodeIndex> rows);
  /// Replaces the hits of all rows by exact form factors between patches (FormFactorMethod::analytic). Keeps the hidden origins
  /// and is_closed that rays found.
  void make_exact();

  /// Returns whether rays may be guided: they come from rays, and no hemicube says where they go.
  bool may_be_guided() const {
    return plan_.needs(Feature::refinement) && options_.form_factors != FormFactorMethod::analytic && !directions_.has_weights();
  }
  /// Sets the guide by which the next rays of a row are sent, or of the children of the row if it is split first.
  void guide(NodeIndex row, const DirectionGuide& guide);
  /// Lets the children of a row that was split have its guide.
  void hand_down_guide(NodeIndex split_row);

  /// Asks for another round of rays for these rows.
  void want_rays(std::span<const NodeIndex> rows);
  bool want_any() const { return !wanting_.empty(); }
  /// Collective. Adds the rays that were asked for to a batch of rows. Returns false, and changes nothing, if the ray budget ran
  /// out.
  bool add_wanted_rays();

  /// Returns a number that grows whenever rays of rows change.
  std::uint64_t changes() const { return changes_; }
  /// Returns whether the rays of a row have changed since changes() was `before`.
  bool has_changed_since(std::uint64_t before, NodeIndex row) const { return changed_at_[row] > before; }
  /// Returns whether rays of a row may have ended in `box`. True where no boxes are kept.
  bool may_end_in(const BoundingBox& box, NodeIndex row) const { return !hit_boxes_ || hit_boxes_->touches(row, box); }
  /// Returns the width of the gap that a row is in, if it is in one (near_surfaces.h). Found once for the same rays. From any
  /// thread, for different rows. Requires: the row's hits are on this rank.
  double gap_before(NodeIndex row);

  /// Finds the leaves on which the hits of rows lie now, for leaves_hit(). Does nothing where no leaf was split and no row has
  /// other hits since. Where `gives_up` returns true, which is asked from any thread, it leaves out the rest of the rows.
  /// Requires: all leaves of the row forest, and their deal().
  void find_hit_leaves(std::span<const NodeIndex> rows, const Deal& deal, const std::function<bool()>& gives_up);

  /// Keeps a box around the hits of each row from now on, so that note_moved() passes over most rows at once. Requires: one rank;
  /// nothing is traced.
  void keep_hit_boxes() { hit_boxes_.emplace(forests_.mesh()), fit_to_nodes(); }

  /// Returns whether the box around a row's patch and its hits touches a place where moved roots were or are. True where that is
  /// not known: no boxes are kept, the row is not traced, or some of its rays met no front.
  bool may_reach(const MovedRoots& moved, NodeIndex row) const {
    return !hit_boxes_ || !is_traced_[row] || !rows_[row].is_closed || moved.touch(hit_boxes_->of(row));
  }

  /// Makes room for new nodes of the row forest.
  void fit_to_nodes();
  /// Forgets the row of a node that was split.
  void forget(NodeIndex row);
  /// Takes roots that the mesh has got; their rows are untraced.
  void append(const AppendedRoots& roots);
  /// Takes roots that have moved since the mesh was `before`: sends the rays again that ended on them, or may meet them where
  /// they are now. The rows that must be traced anew instead are forgotten: those of moved roots, those that touch places where
  /// these were or are, and where not all is known of the rays: where some met no front and a moved root was or is in front of
  /// the row, and, of rows that may reach these places, under panes and media and with hemicubes. Requires: one rank; the scene
  /// is the new one.
  MendedRows note_moved(const BaseMesh& before, const MovedRoots& moved);

  /// Collective. Every rank writes the rows of all.
  void save_rows(PlainWriter& out) const;
  void save_wanted(PlainWriter& out) const;
  void save_guides(PlainWriter& out) const;
  /// Reads what save_rows() wrote in a checkpoint of that version. Throws BadBytes.
  void load_rows(PlainReader& in, std::uint32_t version);
  /// Reads what save_wanted() wrote. Throws BadBytes.
  void load_wanted(PlainReader& in);
  /// Reads what save_guides() wrote. Throws BadBytes.
  void load_guides(PlainReader& in);

  /// Rows that are traced at once. A solve can be interrupted between batches and go on later. Chosen; half and double give the
  /// same solutions (docs/design/constants.md).
  static constexpr std::size_t rows_per_batch = 8192;

 private:
  std::optional<std::vector<TransportRow>> traced(std::span<const NodeIndex> rows, std::span<const RowSize> sizes,
                                                  std::uint64_t seed);
  std::vector<TransportRow> traced_here(std::span<const NodeIndex> rows, std::span<const RowSize> sizes, std::uint64_t seed);
  bool may_hide_otherwise(const MovedRoots& moved, NodeIndex row) const;
  void find_hit_leaves_of(NodeIndex row);
  bool is_far_from(const MovedRoots& moved, NodeIndex row) const;
  void note_hits(std::span<const NodeIndex> rows);
  void note_change(std::span<const NodeIndex> rows);
  void save_batch(std::span<const NodeIndex> rows, PlainWriter& out) const;
  RowSize size_of(PatchId patch) const;

  const Forests& forests_;
  const Plan& plan_;
  const SolveOptions& options_;
  const LocalScene& scene_;
  RayBudget& budget_;
  Ranks& ranks_;
  DirectionSets directions_;
  std::vector<TransportRow> rows_;
  std::vector<bool> is_traced_;
  std::vector<std::vector<NodeIndex>> hit_leaves_;
  std::vector<std::size_t> found_among_;  ///< by row: the number of leaf nodes when find_hit_leaves() was called last
  /// The number of leaf nodes when the leaves of all rows' hits were found last; 0 if hits have changed since.
  std::size_t all_found_among_ = 0;
  std::uint64_t changes_ = 0;
  std::vector<std::uint64_t> changed_at_;  ///< by row: `changes_` at its last change
  std::vector<float> gaps_;                ///< by row: see gap_before(); negative where it is not found
  std::optional<HitBoxes> hit_boxes_;
  std::map<NodeIndex, DirectionGuide> guides_;  ///< of rows whose next rays are to be guided
  std::uint64_t rounds_of_rays_ = 0;            ///< each adds independent rays
  std::vector<NodeIndex> wanting_;              ///< rows that have not got the rays of the newest round
};

}  // namespace alvor
