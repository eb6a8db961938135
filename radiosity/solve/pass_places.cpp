// Compares the told errors of places with the tolerance.

#include "meshing/face_object.h"
#include "radiosity/solve/pass.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cassert>

namespace alvor {

namespace {

// Irradiance, as a share of the mean, below which errors are relative to this instead of the irradiance itself: nobody asks for
// percents of a dark corner. Chosen.
constexpr double darkest = 0.1;
// Share of the tolerance below which a place needs no refinement. Chosen.
constexpr double resolved = 0.7;
// Multiple of the tolerance beyond which an error counts no more for marking, so that places that cannot be resolved do not use
// up the rays of the others. Chosen.
constexpr double most_counted = 2;

double squared(double x) { return x * x; }

/// Returns whether each root counts: all of them, or those of the named objects and of the objects that hang from them.
std::vector<std::uint8_t> counting_roots(const BaseMesh& mesh, const std::vector<std::string>& names) {
  std::vector<std::uint8_t> counts(mesh.roots().size(), names.empty());
  const auto objects = mesh.objects();
  std::vector<std::uint8_t> is_named(objects.size());
  for (std::size_t o = 0; o < objects.size(); ++o)
    is_named[o] = std::ranges::find(names, objects[o].name) != names.end() || (objects[o].parent && is_named[*objects[o].parent]);
  if (std::ranges::find(is_named, true) == is_named.end()) return counts;
  for (std::size_t r = 0; r < counts.size(); ++r)
    if (const auto object = object_of_face(objects, mesh.roots()[r].input.first)) counts[r] = is_named[*object];
  return counts;
}

}  // namespace

std::vector<Pass::PlaceError> Pass::place_errors(const ErrorEstimate& error) const {
  const auto leaves = system_->leaves();
  std::vector<PlaceError> places(leaves.size());
  const std::vector<std::uint8_t> counts = counting_roots(state_.mesh, state_.options.objects);
  tbb::parallel_for(std::size_t{0}, leaves.size(), [&](std::size_t n) {
    places[n].area = state_.rows.may_be_lit(system_->row_of(n)) ? system_->visible_area(n) : 0;
    places[n].irradiance = irradiance_[n].mean();
    places[n].error = told_error(n, error);
  });
  double power = 0, area = 0;
  for (std::size_t n = 0; n < leaves.size(); ++n) {
    power += places[n].area * places[n].irradiance, area += places[n].area;
    if (!counts[state_.forests.leaves().id(leaves[n]).root_face()]) places[n].area = 0;
  }
  const double floor = area > 0 ? darkest * power / area : 0;
  for (PlaceError& place : places) {
    place.relative_to = std::max(place.irradiance, floor);
    place.error = place.relative_to > 0 ? place.error / place.relative_to : 0;
  }
  return places;
}

ErrorByPlace Pass::error_by_place(const ErrorEstimate& error) const {
  assert(stage_ == Stage::estimated);
  std::vector<PlaceError> places = place_errors(error);
  double area = 0, within = 0;
  for (const PlaceError& place : places) {
    area += place.area;
    if (place.error <= state_.options.tolerance) within += place.area;
  }
  ErrorByPlace by_place;
  if (!(area > 0)) return by_place;
  by_place.area_within = std::min(1.0, within / area);
  if (!state_.options.is_by_place()) return by_place;
  std::ranges::sort(places, {}, &PlaceError::error);
  double so_far = 0;
  for (const PlaceError& place : places) {
    if (so_far >= state_.options.area_share * area) break;
    so_far += place.area;
    by_place.kept_error = place.error;
  }
  return by_place;
}

void Pass::refine_only_what_is_not_within(const ErrorEstimate& error) {
  find_candidates();
  const std::vector<PlaceError> places = place_errors(error);
  const double tolerance = state_.options.tolerance;
  std::vector<double> by_leaf(state_.forests.leaves().node_count()), by_row(state_.forests.rows().node_count());
  const auto most = [&](const PlaceError& place) {
    return place.error > resolved * tolerance ? place.area * squared(most_counted * tolerance * place.relative_to) : 0;
  };
  const auto patches = system_->patches();
  for (std::size_t p = 0; p < patches.size(); ++p) {
    for (std::size_t n = patches[p].first_leaf; n < patches[p].first_leaf + patches[p].leaf_count; ++n) {
      by_leaf[system_->leaves()[n]] = most(places[n]);
      by_row[system_->rows()[p]] += most(places[n]);
    }
    // A hidden patch has no visible area of its own: its error is the light that rows lack which see a sliver of it.
    if (patches[p].row->is_hidden()) by_row[system_->rows()[p]] = misfits_[p].unseen.square;
  }
  for (Candidate& candidate : candidates_) {
    const bool is_leaf = candidate.refines_leaf();
    candidate.squared_error = std::min(candidate.squared_error, (is_leaf ? by_leaf : by_row)[candidate.patch]);
  }
  std::erase_if(candidates_, [](const Candidate& candidate) { return candidate.squared_error <= 0; });
}

}  // namespace alvor
