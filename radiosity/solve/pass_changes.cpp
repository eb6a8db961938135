// Finds the rows and leaves of which an estimate must find the errors again. After an edit that leaves most of the scene as it
// was, these are few.

#include "radiosity/solve/pass.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace alvor {

namespace {

// Share of the tolerated error by which light may have changed where errors are not found again. Squares add: an error of the
// tolerance would be 0.1 % larger. Chosen.
constexpr double unnoticed = 0.05;
// Rings of neighbours around rows that have changed, whose windows (fit_field()) hold these rows: a window reaches 3.5 edges.
constexpr int rings_of_window = 4;
// Rings of neighbours in which all rows of a window lie, also where they are a quarter as large. Chosen.
constexpr int rings_of_samples = 14;
// Rings of neighbours around a leaf whose values its interpolation error depends on: slopes of neighbours.
constexpr int rings_of_slopes = 2;

std::vector<std::uint32_t> all_places(std::size_t count) {
  std::vector<std::uint32_t> all(count);
  std::iota(all.begin(), all.end(), 0);
  return all;
}

/// Some places in a list of nodes, each once, with those that are joined smoothly to them.
class Marked {
 public:
  /// Borrows its arguments, both by place. Nodes are less than `node_count`.
  Marked(std::span<const NodeIndex> nodes, std::span<const SmoothNeighbours> neighbours, std::size_t node_count)
      : neighbours_(neighbours), place_of_(node_count), is_marked_(nodes.size()) {
    for (std::uint32_t n = 0; n < nodes.size(); ++n) place_of_[nodes[n]] = n;
  }
  void mark(std::uint32_t place) {
    if (!is_marked_[place]) places_.push_back(place), is_marked_[place] = 1;
  }
  /// Marks the neighbours of all places that are marked, and their neighbours, in `rings` rings.
  void grow(int rings) {
    std::size_t first = 0;
    for (int ring = 0; ring < rings; ++ring) {
      const std::size_t last = places_.size();
      for (; first < last; ++first)
        for (const NodeIndex beside : neighbours_[places_[first]]) mark(place_of_[beside]);
    }
  }
  /// Returns the places, sorted.
  std::vector<std::uint32_t> sorted() const {
    std::vector<std::uint32_t> places(places_);
    std::ranges::sort(places);
    return places;
  }

 private:
  std::span<const SmoothNeighbours> neighbours_;
  std::vector<std::uint32_t> place_of_, places_;
  std::vector<std::uint8_t> is_marked_;
};

}  // namespace

/// Returns whether the errors that are known from the estimate before are of use.
bool Pass::knows_errors() const {
  return state_.ranks.is_alone() && state_.rows.carry_light() && state_.known_errors.are_of(state_.forests);
}

/// Returns by how much the irradiance at a place may have changed, mean over bands, where errors are not found again.
double Pass::unnoticed_change() const { return unnoticed * state_.options.tolerance * state_.known_errors.mean_irradiance(); }

/// Sets the rows of which the field and its errors are found again, and those whose samples that takes.
void Pass::find_changed_rows(std::span<const SmoothNeighbours> neighbours) {
  const auto rows = system_->rows();
  changed_rows_ = sampled_rows_ = all_places(rows.size());
  if (!knows_errors()) return;
  const std::vector<RelativeLight> irradiance = exchange_->irradiance();
  const double least = unnoticed_change();
  Marked marked(rows, neighbours, state_.forests.rows().node_count());
  for (std::uint32_t p = 0; p < rows.size(); ++p) {
    const auto& known = state_.known_errors.of_row(rows[p]);
    if (!known.is_known || std::abs(irradiance[p].mean() - known.irradiance) > least) marked.mark(p);
  }
  marked.grow(rings_of_window);
  changed_rows_ = marked.sorted();
  marked.grow(rings_of_samples);
  sampled_rows_ = marked.sorted();
}

/// Returns the places of the leaves of which errors are found again, and of those whose slopes that takes.
Pass::ChangedLeaves Pass::changed_leaves(std::span<const SmoothNeighbours> neighbours) const {
  const auto leaves = system_->leaves();
  if (!knows_errors()) return {all_places(leaves.size()), all_places(leaves.size())};
  const double least = unnoticed_change();
  Marked marked(leaves, neighbours, state_.forests.leaves().node_count());
  for (const std::uint32_t p : changed_rows_)
    for (std::uint32_t k = 0; k < system_->patches()[p].leaf_count; ++k) marked.mark(system_->patches()[p].first_leaf + k);
  for (std::uint32_t n = 0; n < leaves.size(); ++n) {
    const auto& known = state_.known_errors.of_leaf(leaves[n]);
    if (!known.is_known || std::abs(irradiance_[n].mean() - known.irradiance) > least) marked.mark(n);
  }
  marked.grow(rings_of_slopes);
  ChangedLeaves changed{marked.sorted(), {}};
  marked.grow(1);
  changed.with_slopes = marked.sorted();
  return changed;
}

}  // namespace alvor
