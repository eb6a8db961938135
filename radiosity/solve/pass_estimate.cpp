// Estimates the error of a pass.

#include "radiosity/solve/pass.h"

#include "radiosity/exchange/parallel_sum.h"
#include "radiosity/rays/ray_source.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

namespace alvor {

namespace {

// Share of the variance of a leaf's direct light that is seen in the display. Bilinear interpolation between vertices that
// average the four leaves around them leaves (5/12)^2 = 0.17; the slopes by which the display mesh extrapolates are not in it.
// Chosen; half: error same, rays -1 %, double: error -1 %, rays +3 % (docs/design/constants.md).
constexpr double noise_in_display = 0.16;
// Share of the variance of a leaf's direct light that noise adds to its squared interpolation error. Independent noise on a
// regular grid adds 0.14 inside a surface and 0.30 at a crease (computed from interpolation_error); 0.25 lies between.
constexpr double noise_in_differences = 0.25;
// Share of a window's squared misfit that its fit has at the centre: a guess. Chosen; half: error same, rays +1 %, double: error
// -5 %, rays +10 % (docs/design/constants.md).
constexpr double misfit_at_centre = 0.25;
// Multiple of the noise of origins that a row's misfit must exceed to be worth a split. The mean of sixteen squared normal
// deviations has a standard deviation of sqrt(2 / 16), so this is seven times that: a row that is split loses its rounds of rays.
// Measured for rows of several rounds: with 1 the Cornell box is not told to be within 0.5 % after 30 million rays, with 1.5 it
// is after 21 million, with 2.5 after 12 million, and with 3 its error is a tenth larger; three other scenes have the same error
// after the same time. For rows of one round, converted from margins of a noise that was told 2.5 times as large: with 1.5 errors
// are 10 % smaller after 20 % more rays, but below 1 % noise is taken for detail; with 3.25 half of the gain in furnished_room is
// lost.
constexpr double chance_of_origins = 2.5;
// Multiple of the noise of origins that the misfit of a row of one round must exceed to be part of the told error. Rays of one
// origin may have as much noise as independent ones, 2.5 times the mean that is told. Chosen: two standard deviations above that,
// 2.5 (1 + 2 sqrt(2 / 16)) - 1.
constexpr double sure_of_origins = 3.25;
// Largest share of a patch's irradiance by which it varies over the patch if a solid's outline crosses it. Chosen; half: error +2
// %, rays same, double: error -4 %, rays +55 % (docs/design/constants.md).
constexpr double contact_error = 0.1;

// Share of the squared change of the field across a row that is told as the row's squared error. Where light falls off steeply,
// as towards an edge at which two walls meet, it falls off most steeply beside the edge, within a part of the row that few rays
// start from. Measured on eight scenes with 0, 0.005 and 0.01 (docs/error-vs-time/tried.md): without it 0.64 % is told where
// 0.86 % is true; with 0.01 slats_and_boxes takes a tenth more rays for the same error.
constexpr double detail_of_slope = 0.005;

double squared(double x) { return x * x; }

/// Returns by how much a field changes along u and along v of a patch, squared and summed; emission units squared.
double squared_change(const FieldFit& fit, const BaseMesh& mesh, const PatchShape& shape) {
  const auto corners = corners_of(mesh, shape);
  return squared(fit.change_along(corners[1] - corners[0])) +
         squared(fit.change_along(corners[shape.corner_count == 3 ? 2 : 3] - corners[0]));
}

/// Returns by what errors are multiplied that were told as at least 0 each, so that they add up to the sum of errors of either
/// sign.
double share_of(double sum, double told) { return told > 0 ? std::max(0.0, sum) / told : 0; }

/// Squared errors, integrated over patches: with either sign, as at least 0 each, and their noise.
struct ErrorSums {
  double all = 0, told = 0, noise = 0;

  ErrorSums& operator+=(const ErrorSums& other) {
    all += other.all, told += other.told, noise += other.noise;
    return *this;
  }
};

/// Some leaves of a forest, each with its neighbours, and their centres and values, by node.
struct Field {
  const PatchForest& forest;
  std::span<const NodeIndex> leaves;
  std::span<const SmoothNeighbours> neighbours;
  std::span<const Vec3> centre;
  std::span<const RelativeLight> value;
};

/// Collective. Sets the slope of the mean of bands of each of the leaves at some places.
void find_slopes(const Field& f, std::span<const std::uint32_t> places, std::span<Vec3> by_node, Ranks& ranks) {
  const auto slope = [&](std::size_t k) {
    const RelativeSlope of = leaf_slope(f.forest, f.leaves[places[k]], f.neighbours[places[k]], f.centre, f.value);
    return (of.r + of.g + of.b) / 3;
  };
  if (ranks.is_alone())
    return tbb::parallel_for(std::size_t{0}, places.size(), [&](std::size_t k) { by_node[f.leaves[places[k]]] = slope(k); });
  std::vector<Vec3> slopes(places.size());
  share_work(ranks, std::span(slopes), [&](std::size_t k) { slopes[k] = slope(k); });
  for (std::size_t k = 0; k < slopes.size(); ++k) by_node[f.leaves[places[k]]] = slopes[k];
}

}  // namespace

/// Returns the area of the part of a patch that no solid hides, m2. Faces that light cannot reach count as visible.
double Pass::visible_area(std::size_t patch) const {
  const ShootingPatch& of = system_->patches()[patch];
  return state_.rows.may_be_lit(system_->rows()[patch]) ? of.area * of.row->visible_share() : of.area;
}

/// Returns the irradiance of each patch, mean over its leaves and over bands, by row node; in emission units.
std::vector<double> Pass::irradiance_of_rows() const {
  std::vector<double> irradiance(state_.forests.rows().node_count());
  tbb::parallel_for(std::size_t{0}, system_->patches().size(), [&](std::size_t p) {
    const NodeIndex row = system_->rows()[p];
    double direct = 0;
    for (const NodeIndex leaf : system_->leaves_of(p))
      direct += state_.forests.leaf_area(leaf) * state_.direct[leaf].irradiance.mean();
    irradiance[row] = state_.field.irradiance(row).mean() + direct / system_->patches()[p].area;
  });
  return irradiance;
}

/// Returns by how much the irradiance may vary over the visible part of a patch that a solid's outline crosses, in emission
/// units: a share of it, and no more than the irradiance of lit neighbours differs, if one of them lies beside the outline.
double Pass::contact_variation(NodeIndex row, const SmoothNeighbours& neighbours, std::span<const double> irradiance) const {
  const double most = contact_error * irradiance[row];
  double difference = 0;
  bool is_bounded = false;
  for (const NodeIndex neighbour : neighbours) {
    if (state_.rows[neighbour].is_hidden() || irradiance[neighbour] == 0) continue;
    difference = std::max(difference, std::abs(irradiance[neighbour] - irradiance[row]));
    is_bounded |= !state_.rows[neighbour].crosses_contact();
  }
  return is_bounded ? std::min(most, difference) : most;
}

/// Sets `misfits_`, those of rows that have not changed to what they were. `irradiance` is by row node.
void Pass::find_misfits(std::span<const double> irradiance) {
  const auto rows = system_->rows();
  const bool looks_for_unseen = state_.rows.carry_light() && state_.options.parts.unseen_places;
  std::vector<OriginMisfit> found(changed_rows_.size());
  if (state_.rows.carry_light())
    system_->deal().for_each(state_.ranks, std::span(found), [&](std::size_t n) {
      const NodeIndex row = rows[changed_rows_[n]];
      found[n] = misfit_at_origins(row, strata_[n]);
      if (looks_for_unseen) found[n].unseen = error_at_openings(row, irradiance);
    });
  strata_ = std::vector<StrataSamples>();  // frees the memory
  misfits_.resize(rows.size());
  if (knows_errors())
    tbb::parallel_for(std::size_t{0}, rows.size(), [&](std::size_t p) {
      misfits_[p] = state_.known_errors.of_row(rows[p]).error;
      // The face beyond the opening is another one, whose light may have changed alone.
      if (misfits_[p].unseen.square > 0) misfits_[p].unseen = error_at_openings(rows[p], irradiance);
    });
  for (std::size_t n = 0; n < found.size(); ++n) misfits_[changed_rows_[n]] = found[n];
  lacking_.assign(rows.size(), 0);
  if (looks_for_unseen) find_slivers(irradiance);
}

/// Adds the errors of rows to `error`, squared and integrated over the area, in emission units squared times m2.
void Pass::estimate_rows(ErrorEstimate& error, std::span<const SmoothNeighbours> neighbours) {
  const auto patches = system_->patches();
  const std::vector<double> irradiance = irradiance_of_rows();
  find_misfits(irradiance);
  row_errors_.resize(patches.size());
  row_squares_.assign(patches.size(), 0);
  const auto squares = parallel_sum<ErrorSums>(patches.size(), [&](std::size_t p) {
    const NodeIndex node = system_->rows()[p];
    const TransportRow& row = state_.rows[node];
    const FieldFit& fit = state_.field.fit(node);
    const OriginMisfit& at_origins = misfits_[p];
    const double area = visible_area(p), unseen = at_origins.unseen.square;
    const bool is_seen =
        at_origins.has_several_rounds || at_origins.square > std::max(fit.squared_misfit, sure_of_origins * at_origins.noise);
    const double misfit = is_seen ? at_origins.square : fit.squared_misfit;
    const double by_contact = row.crosses_contact() ? squared(contact_variation(node, neighbours[p], irradiance)) : 0;
    const double unsure = by_contact + detail_of_slope * squared_change(fit, state_.mesh, state_.forests.rows().shape(node));
    const double seen =
        std::max({0.0, at_origins.square - chance_of_origins * at_origins.noise, misfit_at_centre * fit.window_misfit}) + unsure;
    row_errors_[p] = {area * seen + unseen, unseen > area * seen ? at_origins.unseen.split : at_origins.split};
    if (row.is_hidden()) return ErrorSums{};  // what is seen of it lacks elsewhere
    const double more = unseen + lacking_[p], told = area * (std::max(0.0, misfit) + unsure) + more;
    row_squares_[p] = told / area;
    return ErrorSums{area * (misfit + unsure) + more, told, area * fit.variance};
  });
  error.misfit += squares.all;
  error.sampling += squares.noise;
  const double share = share_of(squares.all, squares.told);
  tbb::parallel_for(std::size_t{0}, patches.size(), [&](std::size_t p) {
    row_squares_[p] = share * row_squares_[p] + state_.field.fit(system_->rows()[p]).variance;
  });
}

/// Sets `irradiance_` to that of the field that is shown.
void Pass::find_irradiance() {
  irradiance_.resize(system_->leaves().size());
  tbb::parallel_for(std::size_t{0}, irradiance_.size(), [&](std::size_t n) {
    const NodeIndex leaf = system_->leaves()[n];
    irradiance_[n] = state_.direct[leaf].irradiance + state_.indirect(leaf, system_->row_of(n));
  });
  shows_irradiance_ = true;
}

/// Adds the errors of leaves to `error`, as estimate_rows() does for rows. Returns the power that arrives at all leaves, mean
/// over bands, in emission units times m2.
double Pass::estimate_leaves(ErrorEstimate& error) {
  Forests& forests = state_.forests;
  const auto leaves = system_->leaves();
  std::vector<RelativeLight> irradiance(forests.leaves().node_count());
  find_irradiance();
  tbb::parallel_for(std::size_t{0}, leaves.size(), [&](std::size_t n) { irradiance[leaves[n]] = irradiance_[n]; });
  const auto power =
      parallel_sum<double>(leaves.size(), [this](std::size_t n) { return system_->visible_area(n) * irradiance_[n].mean(); });
  const auto neighbours = forests.leaf_neighbours(leaves);
  const Field field{forests.leaves(), leaves, neighbours, forests.leaf_centres(), irradiance};
  ChangedLeaves changed = changed_leaves(neighbours);
  std::vector<Vec3> slope(forests.leaves().node_count());
  find_slopes(field, changed.with_slopes, slope, state_.ranks);
  changed_leaves_ = std::move(changed.places);
  std::vector<SplitError> found(changed_leaves_.size());
  share_work(state_.ranks, std::span(found), [&](std::size_t k) {
    const std::size_t n = changed_leaves_[k];
    const NodeIndex leaf = leaves[n];
    const double miss = interpolation_error(leaf, neighbours[n], field.centre, field.value, slope);
    const double smooth = squared(miss) - noise_in_differences * state_.direct[leaf].variance;
    const auto [contrast, split] = squared_contrast(n, slope[leaf]);
    found[k] = {system_->visible_area(n) * (contrast > 0 ? std::max(smooth, contrast) : smooth), split};
  });
  leaf_errors_.resize(leaves.size());
  if (knows_errors())
    tbb::parallel_for(std::size_t{0}, leaves.size(),
                      [&](std::size_t n) { leaf_errors_[n] = state_.known_errors.of_leaf(leaves[n]).error; });
  for (std::size_t k = 0; k < found.size(); ++k) leaf_errors_[changed_leaves_[k]] = found[k];
  leaf_squares_.resize(leaves.size());
  const auto squares = parallel_sum<ErrorSums>(leaves.size(), [this](std::size_t n) {
    const double square = unseen_detail * leaf_errors_[n].square;
    leaf_squares_[n] = std::max(0.0, square);
    return ErrorSums{square, leaf_squares_[n], shown_noise(n)};
  });
  error.interpolation += squares.all;
  error.sampling += squares.noise;
  tell_leaves(share_of(squares.all, squares.told));
  return power;
}

/// Returns the noise of a leaf's direct light in the display, squared and integrated over the leaf.
double Pass::shown_noise(std::size_t place) const {
  return noise_in_display * system_->visible_area(place) * state_.direct[system_->leaves()[place]].variance;
}

/// Turns `leaf_squares_`, which holds the interpolation's part integrated over each leaf, into mean squares of all local parts.
void Pass::tell_leaves(double share_of_interpolation) {
  const auto patches = system_->patches();
  tbb::parallel_for(std::size_t{0}, patches.size(), [&](std::size_t p) {
    for (std::size_t n = patches[p].first_leaf; n < patches[p].first_leaf + patches[p].leaf_count; ++n) {
      const NodeIndex leaf = system_->leaves()[n];
      const double area = system_->visible_area(n);
      leaf_squares_[n] = (area > 0 ? share_of_interpolation * leaf_squares_[n] / area : 0) +
                         noise_in_display * state_.direct[leaf].variance + row_squares_[p];
    }
  });
}

/// Returns the told error of the leaf at a place in the system's list, in emission units.
double Pass::told_error(std::size_t place, const ErrorEstimate& error) const {
  const double of_all = squared(error.unshot) + squared(error.balance);
  return std::sqrt(leaf_squares_[place] + of_all * squared(irradiance_[place].mean()));
}

std::vector<float> Pass::leaf_errors(const ErrorEstimate& error) const {
  if (stage_ != Stage::estimated) return {};
  std::vector<float> errors(leaf_squares_.size());
  tbb::parallel_for(std::size_t{0}, errors.size(), [&](std::size_t n) {
    const double told = told_error(n, error);
    errors[n] = static_cast<float>(std::min(state_.in_watts_per_m2({told, told, told}).r, 1e37));
  });
  return errors;
}

std::optional<ErrorEstimate> Pass::estimate(const std::function<bool()>& gives_up) {
  assert(stage_ == Stage::exchanging);
  const auto give_up = [&] {
    state_.known_errors.clear();  // they are of the fields of before
    return std::nullopt;
  };
  exchange_->forget_directions();  // memory is highest from here on, and few passes go on exchanging
  const auto neighbours = state_.forests.row_neighbours(system_->rows());
  if (state_.rows.carry_light()) fit_field_smoothly(neighbours);
  else find_changed_rows(neighbours);
  if (state_.ranks.any_of(gives_up())) return give_up();
  ErrorEstimate error;
  estimate_rows(error, neighbours);
  if (state_.ranks.any_of(gives_up())) return give_up();
  const double power = estimate_leaves(error);
  note_errors();
  stage_ = Stage::estimated;
  if (power <= 0) return ErrorEstimate{};
  const auto area = parallel_sum<double>(system_->patches().size(), [this](std::size_t p) { return visible_area(p); });
  const double mean = power / area;
  for (double* part : {&error.interpolation, &error.misfit, &error.sampling})
    *part = std::sqrt(std::max(0.0, *part) / area) / mean;
  error.unshot = exchange_->remaining_error();
  told_ = error;
  told_scale_ = area * squared(mean);
  return error;
}

}  // namespace alvor
