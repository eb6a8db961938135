// Fits the smooth field of indirect irradiance that is shown.

#include "radiosity/rays/ray_source.h"
#include "radiosity/solve/pass.h"

#include <algorithm>

namespace alvor {

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
  fit_field_smoothly(state_.forests.row_neighbours(system_->rows()));
}

/// Fits the field of the rows that have changed; that of the others is shifted with the irradiance of the row.
void Pass::fit_field_smoothly(std::span<const SmoothNeighbours> neighbours) {
  find_changed_rows(neighbours);
  const auto rows = system_->rows();
  if (knows_errors()) move_field();
  else show(exchange_->irradiance());
  std::vector<NodeIndex> sampled;
  std::vector<SmoothNeighbours> beside;
  std::vector<std::uint32_t> wanted;
  for (std::size_t n = 0, k = 0; n < sampled_rows_.size(); ++n) {
    sampled.push_back(rows[sampled_rows_[n]]);
    beside.push_back(neighbours[sampled_rows_[n]]);
    if (k == changed_rows_.size() || changed_rows_[k] != sampled_rows_[n]) continue;
    wanted.push_back(static_cast<std::uint32_t>(n));
    ++k;
  }
  const auto leaving = system_->radiosity();
  std::vector<RowSamples> samples(sampled.size());
  system_->deal().for_each(state_.ranks, std::span(samples),
                           [&](std::size_t n) { samples[n] = samples_of(sampled[n], leaving); });
  const auto take = [&](std::span<const std::uint32_t> places, std::span<const FieldFit> fits) {
    std::vector<NodeIndex> of(places.size());
    std::ranges::transform(places, of.begin(), [&](std::uint32_t place) { return sampled[place]; });
    state_.field.set_fits(of, fits);
  };
  fit_field(state_.forests.rows(), sampled, beside, samples, state_.forests.row_centres(), wanted, take, state_.ranks);
}

}  // namespace alvor
