// The part of a solve's state that knows how far it is from the truth, and where.

#include "radiosity/solve_state.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace alvor {

namespace {

constexpr double rays_per_leaf_split = 4 * 32;  // four children, 16 to 64 shadow rays each
constexpr double rays_per_row_split = 4 * (rays_per_row + 32);
constexpr std::uint32_t most_rays_per_row = 16 * rays_per_row;
constexpr double contact_error = 0.1;  // of a patch's irradiance: how much it varies where a solid's outline crosses it
constexpr double noise_in_display =
    0.4;  // of the half difference: low-discrepancy halves err less (0.7), interpolation averages (0.6)
constexpr double noise_in_indicator = 0.5;  // of a row's variance: what noise alone adds to a squared indicator

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

std::vector<SmoothNeighbours> find_neighbours(const PatchForest& forest, std::span<const NodeIndex> leaves) {
  std::vector<SmoothNeighbours> neighbours(leaves.size());
  tbb::parallel_for(std::size_t{0}, leaves.size(), [&](std::size_t n) { neighbours[n] = SmoothNeighbours(forest, leaves[n]); });
  return neighbours;
}

}  // namespace

void SolveState::take_smooth_irradiance() {
  take_irradiance();
  if (row_neighbours_.empty()) row_neighbours_ = find_neighbours(row_forest_, patch_row_);
  find_slopes({row_forest_, patch_row_, row_neighbours_, row_centre_, row_irradiance_}, row_slope_);
}

bool SolveState::may_split(Candidate::Kind kind, NodeIndex patch) const {
  if (kind == Candidate::Kind::split_leaf) return leaf_forest_.may_split(patch, limits_);
  const NodeIndex leaf = leaf_node_of_row(patch);
  return row_forest_.may_split(patch, limits_) && (!leaf_forest_.is_leaf(leaf) || leaf_forest_.may_split(leaf, limits_));
}

void SolveState::add_candidates(Candidate::Kind kind, std::span<const NodeIndex> patches, std::span<const double> errors,
                                double rays) {
  for (std::size_t n = 0; n < patches.size(); ++n)
    if (errors[n] > 0 && may_split(kind, patches[n])) candidates_.push_back({kind, patches[n], errors[n], rays});
}

// The two halves of one row tell its variance with one degree of freedom: too rough to act on, so neighbours are averaged in.
std::vector<double> SolveState::row_variances() const {
  const auto differences = shooting_->half_differences();
  std::vector<double> raw(row_forest_.node_count());
  for (std::size_t p = 0; p < patch_row_.size(); ++p) raw[patch_row_[p]] = squared(differences[p].mean());
  std::vector<double> variances;
  variances.reserve(patch_row_.size());
  for (std::size_t p = 0; p < patch_row_.size(); ++p) {
    double sum = raw[patch_row_[p]], count = 1;
    for (const NodeIndex other : row_neighbours_[p]) sum += raw[other], ++count;
    variances.push_back(sum / count);
  }
  return variances;
}

/// Squared errors integrated over the area, W2/m2; returns the power that rows bring, W.
double SolveState::estimate_rows(ErrorEstimate& error) {
  const auto variances = row_variances();
  auto errors = interpolation_errors({row_forest_, patch_row_, row_neighbours_, row_centre_, row_irradiance_}, row_slope_);
  double power = 0;
  for (std::size_t p = 0; p < patches_.size(); ++p) {
    const NodeIndex row = patch_row_[p];
    const double area = patches_[p].area;
    errors[p] = area * std::max(0.0, squared(errors[p]) - noise_in_indicator * variances[p]);
    if (rows_[row].crosses_contact()) {
      const Rgb direct = direct_[patch_leaves_[patches_[p].first_leaf]].irradiance;
      errors[p] += area * squared(contact_error * (row_irradiance_[row] + direct).mean());
    }
    error.indirect_mesh += errors[p];
    const double noise = area * squared(noise_in_display) * variances[p];
    error.sampling += noise;
    power += area * row_irradiance_[row].mean();
    if (noise > 0 && rows_[row].ray_count() < most_rays_per_row)
      candidates_.push_back({Candidate::Kind::add_rays, row, noise, double(rows_[row].ray_count())});
  }
  add_candidates(Candidate::Kind::split_row, patch_row_, errors, rays_per_row_split);
  return power;
}

double SolveState::estimate_leaves(ErrorEstimate& error) {
  std::vector<Rgb> direct(leaf_forest_.node_count());
  double power = 0;
  for (const NodeIndex leaf : patch_leaves_) {
    direct[leaf] = direct_[leaf].irradiance;
    power += leaf_area_[leaf] * direct[leaf].mean();
  }
  const auto neighbours = find_neighbours(leaf_forest_, patch_leaves_);
  const Field field{leaf_forest_, patch_leaves_, neighbours, leaf_centre_, direct};
  std::vector<LeafSlope> slope(leaf_forest_.node_count());
  find_slopes(field, slope);
  auto errors = interpolation_errors(field, slope);
  for (std::size_t n = 0; n < patch_leaves_.size(); ++n) {
    errors[n] *= errors[n] * leaf_area_[patch_leaves_[n]];
    error.direct_mesh += errors[n];
  }
  add_candidates(Candidate::Kind::split_leaf, patch_leaves_, errors, rays_per_leaf_split);
  return power;
}

ErrorEstimate SolveState::estimate() {
  take_smooth_irradiance();
  candidates_.clear();
  ErrorEstimate error;
  const double power = estimate_rows(error) + estimate_leaves(error);
  if (power <= 0) return {};
  double area = 0;
  for (std::size_t p = 0; p < patches_.size(); ++p)
    if (!patches_[p].row->is_hidden()) area += patches_[p].area;
  const double mean = power / area;
  for (double* part : {&error.direct_mesh, &error.indirect_mesh, &error.sampling}) *part = std::sqrt(*part / area) / mean;
  error.unshot = unshot_fraction();
  if (std::ranges::none_of(candidates_, splits) && error.sampling < 0.5 * error.mesh()) candidates_.clear();
  return error;
}

}  // namespace alvor
