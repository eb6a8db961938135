#include "radiosity/exchange/coarse_grid.h"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace alvor {

std::array<CoarseGrid::Matrix, 3> CoarseGrid::matrices(const CoarseUnits& units, const RowHits& hits,
                                                       std::span<const double> weight) {
  std::array<Matrix, 3> bands;
  for (Matrix& band : bands) band.assign(units.count, std::vector<double>(units.count));
  const auto members = units.members();
  const bool lets_light_through = std::ranges::any_of(hits.patches, &ShootingPatch::is_translucent);
  tbb::parallel_for(std::size_t{0}, units.count, [&](std::size_t unit) {
    const auto add = [&](std::size_t to, const Rgb& entry) {
      bands[0][unit][to] += entry.r;
      bands[1][unit][to] += entry.g;
      bands[2][unit][to] += entry.b;
    };
    add(unit, {1, 1, 1});
    for (const std::uint32_t patch : members[unit])
      hits.for_each(patch, [&](std::uint32_t hit, const Rgb& share) {
        add(units.of_patch[hit], -weight[patch] * (share * hits.patches[hit].reflectance));
      });
    if (!lets_light_through) return;
    for (const std::uint32_t patch : members[unit])
      hits.for_each(patch, [&](std::uint32_t hit, const Rgb& share) {
        const std::uint32_t behind = hits.patches[hit].behind;
        if (behind == ShootingPatch::none) return;
        add(units.of_patch[behind], -weight[patch] * (share * hits.patches[behind].diffuse_transmittance));
      });
  });
  return bands;
}

CoarseGrid::CoarseGrid(CoarseUnits units, const RowHits& hits) : units_(std::move(units)) {
  std::vector<double> area(units_.count);
  for (std::size_t p = 0; p < units_.of_patch.size(); ++p) area[units_.of_patch[p]] += hits.patches[p].area;
  for (std::size_t p = 0; p < units_.of_patch.size(); ++p) weight_.push_back(hits.patches[p].area / area[units_.of_patch[p]]);
  for (Matrix& band : matrices(units_, hits, weight_)) band_.emplace_back(std::move(band));
}

void CoarseGrid::correct(std::span<const RelativeLight> residual, std::span<RelativeLight> step) const {
  std::array<std::vector<double>, 3> mean;
  for (auto& band : mean) band.resize(units_.count);
  for (std::size_t p = 0; p < residual.size(); ++p) {
    const std::uint32_t unit = units_.of_patch[p];
    mean[0][unit] += weight_[p] * residual[p].r;
    mean[1][unit] += weight_[p] * residual[p].g;
    mean[2][unit] += weight_[p] * residual[p].b;
  }
  std::array<std::vector<double>, 3> change;
  for (std::size_t b = 0; b < mean.size(); ++b) {
    change[b] = band_[b].solve(mean[b]);
    for (std::size_t unit = 0; unit < units_.count; ++unit) change[b][unit] -= mean[b][unit];
  }
  for (std::size_t p = 0; p < residual.size(); ++p) {
    const std::uint32_t unit = units_.of_patch[p];
    step[p] += {change[0][unit], change[1][unit], change[2][unit]};
  }
}

}  // namespace alvor
