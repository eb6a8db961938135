#include "radiosity/solve/seen_slivers.h"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace alvor {

/// The rows whose origins are all hidden, and their leaves.
class SeenSlivers::HiddenLeaves {
 public:
  HiddenLeaves(const Forests& forests, const TracedRows& rows)
      : is_row_(forests.rows().node_count()), is_leaf_(forests.leaves().node_count()), row_of_(forests.leaves().node_count()) {
    std::vector<NodeIndex> leaves;
    for (const NodeIndex row : forests.all_rows()) {
      if (!rows.is_traced(row) || !rows[row].is_hidden()) continue;
      is_row_[row] = true;
      leaves.clear();
      forests.append_leaves_of_row(row, leaves);
      for (const NodeIndex leaf : leaves) is_leaf_[leaf] = true, row_of_[leaf] = row;
    }
  }

  const std::vector<bool>& rows() const { return is_row_; }  ///< by row node
  bool contains(NodeIndex leaf) const { return is_leaf_[leaf]; }
  /// Returns the row of a leaf. Requires: contains(leaf).
  NodeIndex row_of(NodeIndex leaf) const { return row_of_[leaf]; }

 private:
  std::vector<bool> is_row_, is_leaf_;  // most hits ask no more
  std::vector<NodeIndex> row_of_;
};

std::vector<SeenSlivers::Seen> SeenSlivers::seen_by(const TransportRow& row, std::span<const NodeIndex> leaves,
                                                    const HiddenLeaves& hidden) {
  std::vector<Seen> patches;
  for (std::size_t h = 0; h < leaves.size(); ++h) {
    if (!hidden.contains(leaves[h])) continue;
    const double weight = row.hit_weight.empty() ? 1 : row.hit_weight[h].mean();
    const NodeIndex there = hidden.row_of(leaves[h]);
    const auto seen = std::ranges::find(patches, there, &Seen::hidden);
    if (seen == patches.end()) patches.push_back({there, weight, weight * weight});
    else seen->weight += weight, seen->squared_weight += weight * weight;
  }
  return patches;
}

/// Sets what rows see whose rays have changed, or may end on patches that were not hidden.
void SeenSlivers::look_again(const Forests& forests, const TracedRows& rows, const HiddenLeaves& hidden) {
  const std::vector<NodeIndex> all = forests.all_rows();
  seen_.resize(forests.rows().node_count());
  is_hidden_.resize(seen_.size());
  BoundingBox more;
  for (const NodeIndex row : all)
    if (hidden.rows()[row] && !is_hidden_[row]) more.add(box_of(forests.mesh(), forests.rows().shape(row)));
  is_hidden_ = hidden.rows();
  tbb::parallel_for(std::size_t{0}, all.size(), [&](std::size_t n) {
    const NodeIndex row = all[n];
    if (rows.has_changed_since(changes_, row) || (!more.is_empty() && rows.may_end_in(more, row)))
      seen_[row] = seen_by(rows[row], rows.leaves_hit(row), hidden);
  });
  changes_ = rows.changes();
}

// k (k - 1) is on average the square of the mean of k where rays are independent (Poisson). They are stratified, so it is too
// small for slivers that few rays meet. A single ray counts for nothing: it may have slipped through a seam. Hits of exact rows
// are no rays: all of their weight counts.
std::span<const SeenSlivers::View> SeenSlivers::find(const Forests& forests, const TracedRows& rows) {
  if (changes_ == rows.changes()) return views_;
  look_again(forests, rows, HiddenLeaves(forests, rows));
  views_.clear();
  for (const NodeIndex node : forests.all_rows())
    for (const auto& [there, weight, squared_weight] : seen_[node]) {
      const TransportRow& row = rows[node];
      const double square = weight * weight - (row.origin_hits.empty() ? 0 : squared_weight), count = row.ray_count();
      if (is_hidden_[there] && square > 0) views_.push_back({node, there, square / (count * count)});
    }
  return views_;
}

}  // namespace alvor
