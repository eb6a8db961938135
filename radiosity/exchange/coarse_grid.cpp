#include "radiosity/exchange/coarse_grid.h"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace alvor {

std::vector<std::uint64_t> CoarseGrid::matrices(const CoarseUnits& units, const RowHits& hits, std::span<const double> weight) {
  std::vector<std::uint64_t> entries(units.count * units.count * 3);
  const auto members = units.members();
  const bool lets_light_through = std::ranges::any_of(hits.patches, &ShootingPatch::is_translucent);
  tbb::parallel_for(std::size_t{0}, units.count, [&](std::size_t unit) {
    const auto subtract = [&](std::size_t from, const Rgb& entry) {
      std::uint64_t* const bands = &entries[(unit * units.count + from) * 3];
      bands[0] -= fixed_point(entry.r);
      bands[1] -= fixed_point(entry.g);
      bands[2] -= fixed_point(entry.b);
    };
    for (const std::uint32_t patch : members[unit])
      hits.for_each(patch, [&](std::uint32_t hit, const Rgb& share) {
        subtract(units.of_patch[hit], weight[patch] * (share * hits.patches[hit].reflectance));
      });
    if (!lets_light_through) return;
    for (const std::uint32_t patch : members[unit])
      hits.for_each(patch, [&](std::uint32_t hit, const Rgb& share) {
        const std::uint32_t behind = hits.patches[hit].behind;
        if (behind == ShootingPatch::none) return;
        subtract(units.of_patch[behind], weight[patch] * (share * hits.patches[behind].diffuse_transmittance));
      });
  });
  return entries;
}

CoarseGrid::CoarseGrid(CoarseUnits units, const RowHits& hits, Ranks& ranks) : units_(std::move(units)) {
  std::vector<double> area(units_.count);
  for (std::size_t p = 0; p < units_.of_patch.size(); ++p) area[units_.of_patch[p]] += hits.patches[p].area;
  for (std::size_t p = 0; p < units_.of_patch.size(); ++p) weight_.push_back(hits.patches[p].area / area[units_.of_patch[p]]);
  std::vector<std::uint64_t> entries = matrices(units_, hits, weight_);
  ranks.sum(entries);
  for (std::size_t b = 0; b < 3; ++b) {
    std::vector<std::vector<double>> matrix(units_.count, std::vector<double>(units_.count));
    for (std::size_t i = 0; i < units_.count; ++i)
      for (std::size_t j = 0; j < units_.count; ++j)
        matrix[i][j] = (i == j) + from_fixed_point(entries[(i * units_.count + j) * 3 + b]);
    band_.emplace_back(std::move(matrix));
  }
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
