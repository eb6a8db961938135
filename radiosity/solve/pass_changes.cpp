// Finds the rows and leaves whose errors an estimate finds again. After an edit that leaves most of the scene as it was, these
// are few.

#include "radiosity/exchange/parallel_sum.h"
#include "radiosity/solve/pass.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <functional>
#include <numeric>

namespace alvor {

namespace {

// Share of the tolerated error by which light may have changed where errors are not found again. Squares add: an error of the
// tolerance would be 0.1 % larger. Chosen.
constexpr double unnoticed = 0.05;
// Rings of neighbours around rows that have changed whose fields are found again, too: windows reach 3.5 edges (fit_field()).
// Windows of much larger rows may hold a changed row that is farther off, and are left: their own light has hardly changed.
constexpr int rings_of_window = 4;
// Rings of neighbours in which all rows of a window lie, also where they are a quarter as large. Chosen.
constexpr int rings_of_samples = 14;
// Rings of neighbours around a leaf whose values its interpolation error depends on: slopes of neighbours.
constexpr int rings_of_slopes = 2;

/// Returns whether the light of a row or a leaf has changed by more than `unnoticed_change` since its error was found, or that is
/// not known.
template <class Error>
bool has_changed(const KnownErrors::Known<Error>& known, const RelativeLight& irradiance, double unnoticed_change) {
  return !known.is_known || std::abs(irradiance.mean() - known.irradiance) > unnoticed_change;
}

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
  /// Marks the places where `is_wanted` returns true, which is called in parallel.
  void mark_where(const std::function<bool(std::size_t)>& is_wanted) {
    std::vector<std::uint8_t> wanted(is_marked_.size());
    tbb::parallel_for(std::size_t{0}, wanted.size(), [&](std::size_t n) { wanted[n] = is_wanted(n); });
    for (std::uint32_t n = 0; n < wanted.size(); ++n)
      if (wanted[n]) mark(n);
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

/// Returns whether the errors that are known from the estimate before are of use. They are not where the tolerance is by place:
/// there a small change of light is a large one in the dark.
bool Pass::knows_errors() const { return !state_.options.is_by_place() && !state_.known_errors.empty(); }

/// Returns by how much the irradiance at a place may have changed, mean over bands, where errors are not found again.
/// `irradiance` is by patch, of rows.
double Pass::unnoticed_change(std::span<const RelativeLight> irradiance) const {
  struct Sums {
    double power = 0, area = 0;
    Sums& operator+=(const Sums& other) {
      power += other.power, area += other.area;
      return *this;
    }
  };
  const auto all = parallel_sum<Sums>(irradiance.size(), [&](std::size_t p) {
    Sums of{0, system_->patches()[p].area};
    for (const NodeIndex leaf : system_->leaves_of(p))
      of.power += state_.forests.leaf_area(leaf) * (irradiance[p] + state_.direct[leaf].irradiance).mean();
    return of;
  });
  return unnoticed * state_.options.tolerance * all.power / all.area;
}

/// Sets `changed_rows_`, whose field and errors are found again, and `sampled_rows_`, those in their windows.
void Pass::find_changed_rows(std::span<const SmoothNeighbours> neighbours) {
  const auto rows = system_->rows();
  changed_rows_ = sampled_rows_ = all_places(rows.size());
  if (!knows_errors()) return;
  const std::vector<RelativeLight> irradiance = exchange_->irradiance();
  unnoticed_change_ = unnoticed_change(irradiance);
  Marked marked(rows, neighbours, state_.forests.rows().node_count());
  marked.mark_where(
      [&](std::size_t p) { return has_changed(state_.known_errors.of_row(rows[p]), irradiance[p], unnoticed_change_); });
  marked.grow(rings_of_window);
  changed_rows_ = marked.sorted();
  marked.grow(rings_of_samples);
  sampled_rows_ = marked.sorted();
}

/// Returns the leaves whose errors are found again, and with those around them whose slopes tell of these errors.
Pass::ChangedLeaves Pass::changed_leaves(std::span<const SmoothNeighbours> neighbours) const {
  const auto leaves = system_->leaves();
  if (!knows_errors()) return {all_places(leaves.size()), all_places(leaves.size())};
  Marked marked(leaves, neighbours, state_.forests.leaves().node_count());
  for (const std::uint32_t p : changed_rows_)
    for (std::uint32_t k = 0; k < system_->patches()[p].leaf_count; ++k) marked.mark(system_->patches()[p].first_leaf + k);
  marked.mark_where(
      [&](std::size_t n) { return has_changed(state_.known_errors.of_leaf(leaves[n]), irradiance_[n], unnoticed_change_); });
  marked.grow(rings_of_slopes);
  ChangedLeaves changed{marked.sorted(), {}};
  marked.grow(1);
  changed.with_slopes = marked.sorted();
  return changed;
}

/// Brings what is known from the estimate before up to date, or forgets it where all was found again.
void Pass::note_errors() {
  KnownErrors& known = state_.known_errors;
  if (!knows_errors()) return known.clear();
  for (const std::uint32_t p : changed_rows_) {
    const NodeIndex row = system_->rows()[p];
    known.set_row(row, misfits_[p], state_.field.irradiance(row).mean());
  }
  for (const std::uint32_t n : changed_leaves_) known.set_leaf(system_->leaves()[n], leaf_errors_[n], irradiance_[n].mean());
}

void Pass::keep_errors() {
  assert(stage_ == Stage::estimated);
  if (!state_.known_errors.empty()) return;
  state_.known_errors.make_room(state_.forests);
  note_errors();
}

}  // namespace alvor
