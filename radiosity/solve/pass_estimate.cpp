// Estimates the error of a pass and finds candidates for refinement.

#include "radiosity/solve/pass.h"

#include "radiosity/rays/ray_source.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <functional>

namespace alvor {

namespace {

// A level more of shadow rays: how many times the rays, and the share of the variance that it removes (VisibleFraction).
constexpr double times_rays_of_level = 4, removed_by_rays = 7.0 / 8;
// Shadow rays of a leaf of level 0: the geometric mean of 16 and 64. Splitting it costs those of four children.
constexpr double rays_per_leaf = 32, rays_per_leaf_split = 4 * rays_per_leaf;
// Rays that splitting a row costs: four children, a row and 32 shadow rays each.
constexpr double rays_per_row_split = 4 * (rays_per_row + 32);
// Rays above which a row gets no more. Chosen; half and double give the same solutions (docs/design/constants.md).
constexpr std::uint32_t most_rays_per_row = 16 * rays_per_row;
// Multiple of the leaves' squared errors that is added to the estimate, for shadows smaller than sixteen origins can show.
// Measured on six scenes (ARCHITECTURE.md, Estimate, mark, refine).
constexpr double unseen_detail = 2.5;
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
// Multiple of the noise of origins that their misfit must exceed: sqrt(2 / 16), one standard deviation of the mean of sixteen
// squared normal deviations. With 0 errors are 10 % smaller after 20 % more rays, but below 1 % noise is taken for detail; with
// 0.7 half of the gain in the furnished room is lost (docs/error-vs-time.md).
constexpr double chance_of_origins = 0.35;
// Multiple of the noise of origins that a misfit must exceed to be part of the told error: two standard deviations of that mean.
constexpr double sure_of_origins = 0.7;
// Largest share of a patch's irradiance by which it varies over the patch if a solid's outline crosses it. Chosen; half: error +2
// %, rays same, double: error -4 %, rays +55 % (docs/design/constants.md).
constexpr double contact_error = 0.1;

// Share of the squared error that the limits keep from being refined: rays that would remove less are not sent. Removing all of
// it would make the error a tenth smaller. Chosen.
constexpr double worth_rays = 0.2;

double squared(double x) { return x * x; }

/// Returns by what errors are multiplied that were told as at least 0 each, so that they add up to the sum of errors of either
/// sign.
double share_of(double sum, double told) { return told > 0 ? std::max(0.0, sum) / told : 0; }

/// Some leaves of a forest, each with its neighbours, and their centres and values, by node.
struct Field {
  const PatchForest& forest;
  std::span<const NodeIndex> leaves;
  std::span<const SmoothNeighbours> neighbours;
  std::span<const Vec3> centre;
  std::span<const RelativeLight> value;
};

/// Collective. Sets the slope of each leaf.
void find_slopes(const Field& f, std::span<RelativeSlope> by_node, Ranks& ranks) {
  const auto slope = [&](std::size_t n) { return leaf_slope(f.forest, f.leaves[n], f.neighbours[n], f.centre, f.value); };
  if (ranks.is_alone())
    return tbb::parallel_for(std::size_t{0}, f.leaves.size(), [&](std::size_t n) { by_node[f.leaves[n]] = slope(n); });
  std::vector<RelativeSlope> slopes(f.leaves.size());
  share_work(ranks, std::span(slopes), [&](std::size_t n) { slopes[n] = slope(n); });
  for (std::size_t n = 0; n < slopes.size(); ++n) by_node[f.leaves[n]] = slopes[n];
}

}  // namespace

RowSamples Pass::samples_of(NodeIndex node, const LightByLeaf& radiosity) const {
  const TransportRow& row = state_.rows[node];
  RowSamples quarters;
  if (row.origin_hits.empty()) {
    quarters.fill({state_.field.irradiance(node), double(row.rays)});
    return quarters;
  }
  std::size_t hit = 0;
  for (std::size_t o = 0; o < row.origin_hits.size(); ++o) {
    if (row.origin_hits[o] == TransportRow::not_sampled) continue;
    QuarterSample& quarter = quarters[o % origins_per_patch / 4];
    quarter.rays += rays_per_origin;
    const std::span found = state_.rows.leaves_hit(node).subspan(hit, row.origin_hits[o]);
    quarter.irradiance +=
        row.hit_weight.empty() ? radiosity.sum(found) : radiosity.weighted_sum(found, std::span(row.hit_weight).subspan(hit));
    hit += found.size();
  }
  for (QuarterSample& quarter : quarters)
    if (quarter.rays > 0) quarter.irradiance *= 1 / quarter.rays;
  return quarters;
}

void Pass::show_smoothly() {
  if (!state_.rows.carry_light()) return;
  const auto rows = system_->rows();
  show(exchange_->irradiance());
  const auto neighbours = state_.forests.row_neighbours(rows);
  const auto leaving = system_->radiosity();
  std::vector<RowSamples> samples(rows.size());
  system_->deal().for_each(state_.ranks, std::span(samples), [&](std::size_t p) { samples[p] = samples_of(rows[p], leaving); });
  const auto take = [&](std::size_t first, std::span<const FieldFit> fits) {
    state_.field.set_fits(std::span(rows).subspan(first, fits.size()), fits);
  };
  fit_field(state_.forests.rows(), rows, neighbours, samples, state_.forests.row_centres(), take, state_.ranks);
}

bool Pass::may_split(Candidate::Kind kind, NodeIndex patch, Split how) const {
  const Forests& forests = state_.forests;
  return kind == Candidate::Kind::split_leaf ? forests.may_split_leaf(patch, how) : forests.may_split_row(patch, how);
}

/// Returns the rays that splitting a leaf or a row costs.
double Pass::rays_of_split(Candidate::Kind kind, NodeIndex patch) const {
  return kind == Candidate::Kind::split_leaf ? rays_per_leaf_split * state_.direct.ray_share(patch) : rays_per_row_split;
}

void Pass::add_candidates(Candidate::Kind kind, std::span<const NodeIndex> patches, std::span<const double> errors,
                          std::span<const Split> splits) {
  if (!state_.plan.needs(Feature::refinement)) return;
  for (std::size_t n = 0; n < patches.size(); ++n) {
    if (errors[n] <= 0) continue;
    if (may_split(kind, patches[n], splits[n]))
      candidates_.push_back({kind, patches[n], errors[n], rays_of_split(kind, patches[n]), splits[n]});
    else lasting_error_ += errors[n];
  }
}

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

/// Adds the errors of rows to `error`, squared and integrated over the area, in emission units squared times m2. Adds candidates
/// that split rows or give them more rays.
void Pass::estimate_rows(ErrorEstimate& error) {
  const auto patches = system_->patches();
  const auto leaving = system_->radiosity();
  std::vector<OriginMisfit> at_origins(patches.size());
  std::vector<double> errors(patches.size());
  system_->deal().for_each(state_.ranks, std::span(at_origins),
                           [&](std::size_t p) { at_origins[p] = misfit_at_origins(system_->rows()[p], leaving); });
  for (std::size_t p = 0; p < patches.size(); ++p)
    errors[p] = visible_area(p) * std::max(0.0, at_origins[p].square - chance_of_origins * at_origins[p].noise);
  row_squares_.resize(patches.size());
  const auto neighbours = state_.forests.row_neighbours(system_->rows());
  const std::vector<double> irradiance = irradiance_of_rows();
  double told_misfit = 0;
  for (std::size_t p = 0; p < patches.size(); ++p) {
    const NodeIndex node = system_->rows()[p];
    const TransportRow& row = state_.rows[node];
    const FieldFit& fit = state_.field.fit(node);
    const double area = visible_area(p), noise = area * fit.variance;
    const bool is_seen = row.origin_hits.size() > origins_per_patch ||
                         at_origins[p].square > std::max(fit.squared_misfit, sure_of_origins * at_origins[p].noise);
    const double misfit = is_seen ? at_origins[p].square : fit.squared_misfit;
    error.misfit += area * misfit;
    row_squares_[p] = std::max(0.0, misfit);
    errors[p] = std::max(errors[p], area * misfit_at_centre * fit.window_misfit);
    if (row.crosses_contact()) {
      const double by_contact = area * squared(contact_variation(node, neighbours[p], irradiance));
      errors[p] += by_contact;
      error.misfit += by_contact;
      row_squares_[p] += area > 0 ? by_contact / area : 0;
    }
    told_misfit += area * row_squares_[p];
    error.sampling += noise;
    const double rays = row.ray_count();
    if (noise > 0 && rays < most_rays_per_row)
      candidates_.push_back({Candidate::Kind::add_rays, node, noise * rays_per_row / (rays + rays_per_row), rays_per_row});
  }
  const double share = share_of(error.misfit, told_misfit);
  for (std::size_t p = 0; p < patches.size(); ++p)
    row_squares_[p] = share * row_squares_[p] + state_.field.fit(system_->rows()[p]).variance;
  std::vector<Split> splits;
  for (const OriginMisfit& misfit : at_origins) splits.push_back(misfit.split);
  add_candidates(Candidate::Kind::split_row, system_->rows(), errors, splits);
}

/// Returns the irradiance of the leaf at a place in the system's list, in emission units.
RelativeLight Pass::irradiance_at(std::size_t place) const {
  const NodeIndex leaf = system_->leaves()[place];
  return state_.direct[leaf].irradiance + state_.indirect(leaf, system_->row_of(place));
}

/// Returns how much of the squared error of a leaf, integrated over it, splitting the leaf would remove. Both parts of the error,
/// what interpolation misses and the noise of shadow rays, go where the edge of a shadow leaves the smaller leaves. Where noise
/// is the larger part, there is no edge to find, and smaller leaves are as noisy: then this adds a candidate that gives the leaf
/// more shadow rays instead. So it does where a leaf cannot be split, and noise of its origins may be part of what is taken for
/// missed.
double Pass::heed_noise(std::size_t place, Split how, double missed, double noise) {
  const NodeIndex leaf = system_->leaves()[place];
  const bool may_split = state_.forests.may_split_leaf(leaf, how);
  const double doubtful = may_split ? 0 : system_->visible_area(place) * noise_of_origins * state_.direct[leaf].origin_variance;
  if (state_.direct.may_add_rays(leaf) && noise + doubtful > missed) {
    const double in_doubt = std::min(missed, doubtful) / 2, removed = removed_by_rays * noise + in_doubt;
    if (!may_split) lasting_error_ += missed - in_doubt;
    candidates_.push_back(
        {Candidate::Kind::add_shadow_rays, leaf, removed, times_rays_of_level * rays_per_leaf * state_.direct.ray_share(leaf)});
    return 0;
  }
  if (noise <= missed) return missed + noise;
  lasting_error_ += noise;
  return missed;
}

/// Adds the errors of leaves to `error`, and candidates that split leaves, as estimate_rows() does for rows. Returns the power
/// that arrives at all leaves, mean over bands, in emission units times m2.
double Pass::estimate_leaves(ErrorEstimate& error) {
  Forests& forests = state_.forests;
  const auto leaves = system_->leaves();
  std::vector<RelativeLight> irradiance(forests.leaves().node_count());
  tbb::parallel_for(std::size_t{0}, leaves.size(), [&](std::size_t n) { irradiance[leaves[n]] = irradiance_at(n); });
  double power = 0;
  for (std::size_t n = 0; n < leaves.size(); ++n) power += system_->visible_area(n) * irradiance[leaves[n]].mean();
  const auto neighbours = forests.leaf_neighbours(leaves);
  const Field field{forests.leaves(), leaves, neighbours, forests.leaf_centres(), irradiance};
  std::vector<RelativeSlope> slope(forests.leaves().node_count());
  find_slopes(field, slope, state_.ranks);
  struct LeafError {
    double square = 0;
    Split split = Split::quarters;
  };
  std::vector<LeafError> found(leaves.size());
  share_work(state_.ranks, std::span(found), [&](std::size_t n) {
    const NodeIndex leaf = leaves[n];
    const double miss = interpolation_error(leaf, neighbours[n], field.centre, field.value, slope);
    const double smooth = squared(miss) - noise_in_differences * state_.direct[leaf].variance;
    const auto [contrast, split] = squared_contrast(n, slope[leaf]);
    found[n] = {system_->visible_area(n) * (contrast > 0 ? std::max(smooth, contrast) : smooth), split};
  });
  std::vector<double> errors(leaves.size());
  std::vector<Split> splits(leaves.size());
  leaf_squares_.resize(leaves.size());
  double told_interpolation = 0;
  for (std::size_t n = 0; n < leaves.size(); ++n) {
    const double noise = noise_in_display * system_->visible_area(n) * state_.direct[leaves[n]].variance;
    errors[n] = found[n].square, splits[n] = found[n].split;
    error.interpolation += unseen_detail * errors[n];
    error.sampling += noise;
    leaf_squares_[n] = unseen_detail * std::max(0.0, errors[n]);
    told_interpolation += leaf_squares_[n];
    errors[n] = heed_noise(n, splits[n], std::max(0.0, errors[n]), noise);
  }
  tell_leaves(share_of(error.interpolation, told_interpolation));
  split_rows_as_leaves(splits);
  add_candidates(Candidate::Kind::split_leaf, leaves, errors, splits);
  return power;
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

/// Returns the told error of the leaf at a place in the system's list, where this irradiance arrives; in emission units.
double Pass::told_error(std::size_t place, const RelativeLight& irradiance, const ErrorEstimate& error) const {
  const double of_all = squared(error.unshot) + squared(error.balance);
  return std::sqrt(leaf_squares_[place] + of_all * squared(irradiance.mean()));
}

std::vector<float> Pass::leaf_errors(const ErrorEstimate& error) const {
  if (stage_ != Stage::estimated) return {};
  std::vector<float> errors(leaf_squares_.size());
  tbb::parallel_for(std::size_t{0}, errors.size(), [&](std::size_t n) {
    const double told = told_error(n, irradiance_at(n), error);
    errors[n] = static_cast<float>(std::min(state_.in_watts_per_m2({told, told, told}).r, 1e37));
  });
  return errors;
}

/// Drops the candidates that add rays if the error that would need splits which the limits forbid is beyond the tolerance, and
/// all of these rays would hardly reduce it.
void Pass::drop_rays_that_do_not_help(double lasting_error) {
  if (state_.options.is_by_place() || lasting_error <= state_.options.tolerance) return;
  double removable = 0;
  for (const Candidate& candidate : candidates_)
    if (!candidate.splits()) removable += candidate.squared_error;
  if (removable < worth_rays * lasting_error_) std::erase_if(candidates_, std::not_fn(&Candidate::splits));
}

ErrorEstimate Pass::estimate() {
  assert(stage_ == Stage::exchanging);
  stage_ = Stage::estimated;
  exchange_->forget_directions();  // memory is highest from here on, and only the last pass goes on exchanging
  show_smoothly();
  candidates_.clear();
  lasting_error_ = 0;
  ErrorEstimate error;
  estimate_rows(error);
  const double power = estimate_leaves(error);
  if (power <= 0) return {};
  double area = 0;
  const auto patches = system_->patches();
  for (std::size_t p = 0; p < patches.size(); ++p) area += visible_area(p);
  const double mean = power / area;
  for (double* part : {&error.interpolation, &error.misfit, &error.sampling})
    *part = std::sqrt(std::max(0.0, *part) / area) / mean;
  error.unshot = exchange_->remaining_error();
  if (std::ranges::none_of(candidates_, &Candidate::splits) && error.sampling < 0.5 * error.mesh()) candidates_.clear();
  drop_rays_that_do_not_help(std::sqrt(lasting_error_ / area) / mean);
  return error;
}

}  // namespace alvor
