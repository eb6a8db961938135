// The part of a solve's state that knows how far it is from the truth, and where.

#include "radiosity/solve/solve_state.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace alvor {

namespace {

constexpr double rays_per_leaf_split = 4 * 32;  // four children, 16 to 64 shadow rays each
constexpr double rays_per_row_split = 4 * (rays_per_row + 32);
constexpr std::uint32_t most_rays_per_row = 16 * rays_per_row;
constexpr double unseen_detail = 2.5;  // of the squared error: shadows smaller than what sixteen origins tell, from many scenes
constexpr double noise_in_display = 0.16;      // of the variance of direct light: vertices average over the leaves around them
constexpr double noise_in_differences = 0.25;  // of that variance: what noise adds to a squared interpolation error
constexpr double noise_of_origins = 1.7;       // of their variance, and what it may be above that by chance
constexpr double misfit_at_centre = 0.25;      // of the squared misfit in a window, that its fit has in the middle
constexpr double contact_error = 0.1;          // of a patch's irradiance: how much it varies where a solid's outline crosses it

const FieldFit no_field{};

bool splits(const Candidate& candidate) { return candidate.kind != Candidate::Kind::add_rays; }

double squared(double x) { return x * x; }

/// Some leaves of a forest, each with its neighbours, and what they hold, by node.
struct Field {
  const PatchForest& forest;
  std::span<const NodeIndex> leaves;
  std::span<const SmoothNeighbours> neighbours;
  std::span<const Vec3> centre;
  std::span<const Rgb> value;
};

template <class Body>
void for_each_leaf(const Field& field, Body&& body) {
  tbb::parallel_for(std::size_t{0}, field.leaves.size(), std::forward<Body>(body));
}

void find_slopes(const Field& f, std::span<LeafSlope> by_node) {
  for_each_leaf(
      f, [&](std::size_t n) { by_node[f.leaves[n]] = leaf_slope(f.forest, f.leaves[n], f.neighbours[n], f.centre, f.value); });
}

std::vector<double> interpolation_errors(const Field& f, std::span<const LeafSlope> slope) {
  std::vector<double> errors(f.leaves.size());
  for_each_leaf(f,
                [&](std::size_t n) { errors[n] = interpolation_error(f.leaves[n], f.neighbours[n], f.centre, f.value, slope); });
  return errors;
}

}  // namespace

/// By leaf: emitted, and reflected of what arrives, as it is shown.
LightByLeaf SolveState::radiosity() const {
  LightByLeaf radiosity(leaf_forest_.node_count(), plan_.needs(Feature::three_bands));
  for (std::size_t p = 0; p < patches_.size(); ++p)
    for (std::uint32_t k = patches_[p].first_leaf; k < patches_[p].first_leaf + patches_[p].leaf_count; ++k)
      radiosity.set(patch_leaves_[k], own_radiosity_[k] + patches_[p].reflectance * row_irradiance_[patch_row_[p]]);
  return radiosity;
}

RowSamples SolveState::samples_of(NodeIndex node, const LightByLeaf& radiosity) const {
  const TransportRow& row = rows_[node];
  RowSamples quarters;
  if (row.origin_hits.empty()) {
    quarters.fill({row_irradiance_[node], double(row.rays)});
    return quarters;
  }
  std::size_t hit = 0;
  for (std::size_t o = 0; o < row.origin_hits.size(); ++o) {
    if (row.origin_hits[o] == TransportRow::not_sampled) continue;
    QuarterSample& quarter = quarters[o % origins_per_patch / 4];
    quarter.rays += rays_per_origin;
    const std::span found = std::span(hit_leaves_[node]).subspan(hit, row.origin_hits[o]);
    quarter.irradiance +=
        row.hit_weight.empty() ? radiosity.sum(found) : radiosity.weighted_sum(found, std::span(row.hit_weight).subspan(hit));
    hit += found.size();
  }
  for (QuarterSample& quarter : quarters)
    if (quarter.rays > 0) quarter.irradiance *= 1 / quarter.rays;
  return quarters;
}

void SolveState::show_smoothly() {
  if (!has_rows()) return;
  show();
  const auto row_neighbours = row_neighbours_.of(patch_row_);
  const auto leaving = radiosity();
  std::vector<RowSamples> samples(patch_row_.size());
  tbb::parallel_for(std::size_t{0}, patch_row_.size(), [&](std::size_t p) { samples[p] = samples_of(patch_row_[p], leaving); });
  const auto fits = fit_field(row_forest_, patch_row_, row_neighbours, samples, row_centre_);
  for (std::size_t p = 0; p < patch_row_.size(); ++p) row_fit_[patch_row_[p]] = fits[p];
}

void SolveState::show_what_came_since() {
  if (!has_rows()) return;
  const auto irradiance = exchange_->irradiance();
  for (std::size_t p = 0; p < patch_row_.size(); ++p) {
    const NodeIndex row = patch_row_[p];
    row_fit_[row].add(irradiance[p] - row_irradiance_[row]);
    row_irradiance_[row] = irradiance[p];
  }
}

bool SolveState::may_split(Candidate::Kind kind, NodeIndex patch) const {
  if (kind == Candidate::Kind::split_leaf) return leaf_forest_.may_split(patch, limits_);
  const NodeIndex leaf = leaf_node_of_row(patch);
  return row_forest_.may_split(patch, limits_) && (!leaf_forest_.is_leaf(leaf) || leaf_forest_.may_split(leaf, limits_));
}

void SolveState::add_candidates(Candidate::Kind kind, std::span<const NodeIndex> patches, std::span<const double> errors,
                                double rays) {
  if (!plan_.needs(Feature::refinement)) return;
  for (std::size_t n = 0; n < patches.size(); ++n)
    if (errors[n] > 0 && may_split(kind, patches[n])) candidates_.push_back({kind, patches[n], errors[n], rays});
}

/// Squared errors integrated over the area, W2/m2.
void SolveState::estimate_rows(ErrorEstimate& error) {
  std::vector<double> errors(patches_.size());
  for (std::size_t p = 0; p < patches_.size(); ++p) {
    const NodeIndex row = patch_row_[p];
    const FieldFit& fit = has_rows() ? row_fit_[row] : no_field;
    const double area = patches_[p].area, noise = area * fit.variance;
    error.misfit += area * fit.squared_misfit;
    errors[p] = area * misfit_at_centre * fit.window_misfit;
    if (rows_[row].crosses_contact()) {
      const Rgb direct = direct_[patch_leaves_[patches_[p].first_leaf]].irradiance;
      const double by_contact = area * squared(contact_error * ((has_rows() ? row_irradiance_[row] : Rgb{}) + direct).mean());
      errors[p] += by_contact;
      error.misfit += by_contact;
    }
    error.sampling += noise;
    const double rays = rows_[row].ray_count();
    if (noise > 0 && rays < most_rays_per_row)
      candidates_.push_back({Candidate::Kind::add_rays, row, noise * rays_per_row / (rays + rays_per_row), rays_per_row});
  }
  add_candidates(Candidate::Kind::split_row, patch_row_, errors, rays_per_row_split);
}

/// Mean square of what arrives at the origins of a leaf beyond its slope and the noise of their shadow rays.
double SolveState::squared_contrast(NodeIndex leaf, const Rgb& irradiance, const LeafSlope& slope) const {
  const PatchShape shape = leaf_forest_.shape(leaf);
  const Vec3 steepest = (slope.r + slope.g + slope.b) / 3;
  double squares = 0;
  for (int k = 0; k < 4; ++k) {
    const PatchShape quarter = shape.child(k);
    const double by_rows = indirect(leaf, centre_of(mesh_, quarter)).mean();
    for (int o = 0; o < 4; ++o) {
      const Vec3 offset = centre_of(mesh_, quarter.child(o)) - leaf_centre_[leaf];
      squares += squared(direct_[leaf].at_origin[4 * k + o] + by_rows - irradiance.mean() - dot(steepest, offset));
    }
  }
  return std::max(0.0, squares / origins_per_patch - noise_of_origins * direct_[leaf].origin_variance);
}

/// The same; returns the power that arrives, W.
double SolveState::estimate_leaves(ErrorEstimate& error) {
  std::vector<Rgb> irradiance(leaf_forest_.node_count());
  tbb::parallel_for(std::size_t{0}, patch_leaves_.size(), [&](std::size_t n) {
    irradiance[patch_leaves_[n]] = direct_[patch_leaves_[n]].irradiance + indirect(patch_leaves_[n]);
  });
  double power = 0;
  for (const NodeIndex leaf : patch_leaves_) power += leaf_area_[leaf] * irradiance[leaf].mean();
  const auto neighbours = leaf_neighbours_.of(patch_leaves_);
  const Field field{leaf_forest_, patch_leaves_, neighbours, leaf_centre_, irradiance};
  std::vector<LeafSlope> slope(leaf_forest_.node_count());
  find_slopes(field, slope);
  auto errors = interpolation_errors(field, slope);
  for_each_leaf(field, [&](std::size_t n) {
    const NodeIndex leaf = patch_leaves_[n];
    const double smooth = squared(errors[n]) - noise_in_differences * direct_[leaf].variance;
    const double contrast = squared_contrast(leaf, irradiance[leaf], slope[leaf]);
    errors[n] = leaf_area_[leaf] * (contrast > 0 ? std::max(smooth, contrast) : smooth);
  });
  for (std::size_t n = 0; n < patch_leaves_.size(); ++n) {
    const NodeIndex leaf = patch_leaves_[n];
    const double noise = noise_in_display * leaf_area_[leaf] * direct_[leaf].variance;
    error.interpolation += unseen_detail * errors[n];
    error.sampling += noise;
    errors[n] = std::max(0.0, errors[n]) + noise;
  }
  add_candidates(Candidate::Kind::split_leaf, patch_leaves_, errors, rays_per_leaf_split);
  return power;
}

ErrorEstimate SolveState::estimate() {
  show_smoothly();
  candidates_.clear();
  ErrorEstimate error;
  estimate_rows(error);
  const double power = estimate_leaves(error);
  if (power <= 0) return {};
  double area = 0;
  for (std::size_t p = 0; p < patches_.size(); ++p)
    if (!patches_[p].row->is_hidden() || !may_be_lit(patch_row_[p])) area += patches_[p].area;
  const double mean = power / area;
  for (double* part : {&error.interpolation, &error.misfit, &error.sampling})
    *part = std::sqrt(std::max(0.0, *part) / area) / mean;
  error.unshot = exchange_->remaining_error();
  if (std::ranges::none_of(candidates_, splits) && error.sampling < 0.5 * error.mesh()) candidates_.clear();
  return error;
}

}  // namespace alvor
