#include "radiosity/solve/seen_slivers.h"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace alvor {

namespace {

/// The leaves of rows whose origins are all hidden.
class HiddenLeaves {
 public:
  HiddenLeaves(const Forests& forests, const TracedRows& rows)
      : is_hidden_(forests.leaves().node_count()), row_of_(forests.leaves().node_count()) {
    std::vector<NodeIndex> leaves;
    for (const NodeIndex row : forests.all_rows()) {
      if (!rows.is_traced(row) || !rows[row].is_hidden()) continue;
      leaves.clear();
      forests.append_leaves_of_row(row, leaves);
      for (const NodeIndex leaf : leaves) is_hidden_[leaf] = true, row_of_[leaf] = row;
      is_empty_ = false;
    }
  }

  bool is_empty() const { return is_empty_; }
  bool contains(NodeIndex leaf) const { return is_hidden_[leaf]; }
  /// Returns the row of a leaf. Requires: contains(leaf).
  NodeIndex row_of(NodeIndex leaf) const { return row_of_[leaf]; }

 private:
  std::vector<bool> is_hidden_;  // most hits ask no more
  std::vector<NodeIndex> row_of_;
  bool is_empty_ = true;
};

/// The weights of a row's rays that end on one patch.
struct Seen {
  NodeIndex hidden;
  double weight, squared_weight;
};

std::vector<Seen> seen_by(const TransportRow& row, std::span<const NodeIndex> leaves, const HiddenLeaves& hidden) {
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

}  // namespace

// k (k - 1) is on average the square of the mean of k where rays are independent (Poisson). They are stratified, so it is too
// small for slivers that few rays meet. A single ray counts for nothing: it may have slipped through a seam. Hits of exact rows
// are no rays: all of their weight counts.
std::span<const SeenSlivers::View> SeenSlivers::find(const Forests& forests, const TracedRows& rows) {
  if (changes_ == rows.changes()) return views_;
  changes_ = rows.changes();
  views_.clear();
  const HiddenLeaves hidden(forests, rows);
  if (hidden.is_empty()) return views_;
  const std::vector<NodeIndex> all = forests.all_rows();
  std::vector<std::vector<Seen>> seen(all.size());
  tbb::parallel_for(std::size_t{0}, all.size(),
                    [&](std::size_t n) { seen[n] = seen_by(rows[all[n]], rows.leaves_hit(all[n]), hidden); });
  for (std::size_t n = 0; n < all.size(); ++n)
    for (const auto& [there, weight, squared_weight] : seen[n]) {
      const TransportRow& row = rows[all[n]];
      const double square = weight * weight - (row.origin_hits.empty() ? 0 : squared_weight), count = row.ray_count();
      if (square > 0) views_.push_back({all[n], there, square / (count * count)});
    }
  return views_;
}

}  // namespace alvor
