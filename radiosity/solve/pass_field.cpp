// Fits the smooth field of indirect irradiance that is shown.

#include "radiosity/estimate/origin_sample.h"
#include "radiosity/rays/ray_source.h"
#include "radiosity/solve/pass.h"

#include <algorithm>

namespace alvor {

namespace {

// Share of the variance of sixteen independent rays that the stratified rays of an origin have, on average over rows. Measured:
// the median of misfit over noise of rows of one round is -0.6 with 1, where that of rows of several rounds is near 0.
constexpr double stratified_noise = 0.4;
constexpr std::uint32_t not_changed = ~0u;  // the place of a row among others that have changed

/// Returns the sample of an origin of which all rays hit `found` with these weights, in a row whose irradiance is `around`.
OriginSample guided_sample(const LightByLeaf& radiosity, std::span<const NodeIndex> found, std::span<const RgbF> weight,
                           double around) {
  GuidedOrigin origin(around);
  for (std::size_t h = 0; h < found.size(); ++h)
    origin.add(radiosity.sums(found.subspan(h, 1), {}).light.mean(), weight[h].mean());
  return origin.sample();
}

/// The rounds of rays that a stratum of a row has.
struct StratumRounds {
  double sum = 0, squares = 0, count = 0, noise_of_rays = 0;

  void add(const OriginSample& round) {
    sum += round.irradiance, squares += round.irradiance * round.irradiance, count += 1;
    noise_of_rays += round.noise;
  }
  double mean() const { return sum / count; }
  /// Returns the variance of the mean.
  double noise() const {
    return count > 1 ? std::max(0.0, squares / count - mean() * mean()) / (count - 1) : stratified_noise * noise_of_rays;
  }
};

}  // namespace

/// Returns whether all rays of a row hit, and its weights come from no medium, pane or hemicube: each is 1, or that of a guided
/// ray.
bool Pass::has_only_guided_weights(const TransportRow& row) const {
  return row.is_closed && !row.hit_weight.empty() && state_.rows.may_be_guided() && !state_.plan.needs(Feature::medium) &&
         !state_.plan.needs(Feature::panes);
}

// In rows of several rounds of rays each stratum has the mean over its rounds, and its noise is found from how these differ. With
// one round the noise is found from how the rays of the origin differ.
Pass::RowView Pass::view_of(NodeIndex node, const LightByLeaf& radiosity) const {
  const TransportRow& row = state_.rows[node];
  RowView view;
  if (row.origin_hits.empty()) {
    view.quarters.fill({state_.field.irradiance(node), double(row.rays)});
    return view;
  }
  const bool is_guided = has_only_guided_weights(row);
  const double around = state_.field.irradiance(node).mean();
  std::array<StratumRounds, origins_per_patch> strata;
  std::size_t hit = 0;
  for (std::size_t o = 0; o < row.origin_hits.size(); ++o) {
    if (row.origin_hits[o] == TransportRow::not_sampled) continue;
    const std::span found = state_.rows.leaves_hit(node).subspan(hit, row.origin_hits[o]);
    const auto weight = row.hit_weight.empty() ? std::span<const RgbF>() : std::span(row.hit_weight).subspan(hit);
    const auto [light, squares] = radiosity.sums(found, weight);
    hit += found.size();
    QuarterSample& quarter = view.quarters[o % origins_per_patch / 4];
    quarter.rays += rays_per_origin;
    quarter.irradiance += light;
    strata[o % origins_per_patch].add(is_guided ? guided_sample(radiosity, found, weight, around)
                                                : sample_of(light.mean(), squares, rays_per_origin));
  }
  for (QuarterSample& quarter : view.quarters)
    if (quarter.rays > 0) quarter.irradiance *= 1 / quarter.rays;
  for (std::size_t k = 0; k < strata.size(); ++k)
    if (strata[k].count > 0) view.strata[k] = {static_cast<float>(strata[k].mean()), static_cast<float>(strata[k].noise())};
  return view;
}

void Pass::show_smoothly() {
  if (!state_.rows.carry_light()) return;
  fit_field_smoothly(state_.forests.row_neighbours(system_->rows()));
}

/// Fits the field of the rows that have changed; that of the others is shifted with the irradiance of the row.
void Pass::fit_field_smoothly(std::span<const SmoothNeighbours> neighbours) {
  shows_irradiance_ = false;
  find_changed_rows(neighbours);
  const auto rows = system_->rows();
  if (changed_rows_.size() < rows.size()) move_field();
  else state_.field.set_irradiance(rows, exchange_->irradiance());
  std::vector<NodeIndex> sampled;
  std::vector<SmoothNeighbours> beside;
  std::vector<std::uint32_t> wanted, place_among_changed(sampled_rows_.size(), not_changed);
  for (std::size_t n = 0, k = 0; n < sampled_rows_.size(); ++n) {
    sampled.push_back(rows[sampled_rows_[n]]);
    beside.push_back(neighbours[sampled_rows_[n]]);
    if (k == changed_rows_.size() || changed_rows_[k] != sampled_rows_[n]) continue;
    wanted.push_back(static_cast<std::uint32_t>(n));
    place_among_changed[n] = static_cast<std::uint32_t>(k++);
  }
  const auto leaving = system_->radiosity();
  std::vector<RowSamples> samples(sampled.size());
  strata_.resize(changed_rows_.size());
  system_->deal().for_each(state_.ranks, std::span(samples), [&](std::size_t n) {
    const RowView view = view_of(sampled[n], leaving);
    samples[n] = view.quarters;
    if (place_among_changed[n] != not_changed) strata_[place_among_changed[n]] = view.strata;
  });
  const auto take = [&](std::span<const std::uint32_t> places, std::span<const FieldFit> fits) {
    std::vector<NodeIndex> of(places.size());
    std::ranges::transform(places, of.begin(), [&](std::uint32_t place) { return sampled[place]; });
    state_.field.set_fits(of, fits);
  };
  fit_field(state_.forests.rows(), sampled, beside, samples, state_.forests.row_centres(), wanted, take, state_.ranks);
}

}  // namespace alvor
