#include "radiosity/estimate/axis_contrast.h"

#include <algorithm>
#include <bit>

namespace alvor {

namespace {

// See best_split().
constexpr double worth_slabs = 4;
// Multiple of the noise of means that a variance must exceed: of patches of noise alone, 3 % are then split into slabs (measured,
// AxisContrast.NoiseSeldomAsksForSlabs).
constexpr double sure = 2.6;

}  // namespace

AxisContrast::AxisContrast(const PatchShape& patch)
    : cells_(patch.corner_count == 4 ? &cells_of(patch.strata_along_u) : nullptr) {}

AxisContrast::Cells::Cells(int strata_along_u)
    : columns(static_cast<std::size_t>(strata_along_u)), rows(strata_per_patch / columns) {
  const PatchShape whole = PatchShape::whole(0, 4, strata_along_u);
  for (int o = 0; o < strata_per_patch; ++o) {
    const Uv at = whole.stratum_centre(o);
    column[static_cast<std::size_t>(o)] = static_cast<std::uint8_t>(at.u * strata_along_u);
    row[static_cast<std::size_t>(o)] = static_cast<std::uint8_t>(at.v * (strata_per_patch / strata_along_u));
  }
}

const AxisContrast::Cells& AxisContrast::cells_of(int strata_along_u) {
  static const std::array<Cells, 5> cells{Cells(1), Cells(2), Cells(4), Cells(8), Cells(16)};
  return cells[static_cast<std::size_t>(std::countr_zero(static_cast<std::uint32_t>(strata_along_u)))];
}

void AxisContrast::add(int stratum, double value) {
  if (!cells_) return;
  const auto o = static_cast<std::size_t>(stratum);
  for (Line* line : {&columns_[cells_->column[o]], &rows_[cells_->row[o]]}) line->sum += value, line->count += 1;
}

AxisContrast::Variance AxisContrast::variance_between(std::span<const Line> lines) {
  double sum = 0, squares = 0, used = 0, shares = 0;
  for (const Line& line : lines) {
    if (line.count == 0) continue;
    const double mean = line.sum / line.count;
    sum += mean, squares += mean * mean, used += 1, shares += 1 / line.count;
  }
  if (used < 2) return {0, 1};
  return {std::max(0.0, squares / used - sum / used * (sum / used)), shares / used};
}

Split AxisContrast::best_split(double noise) const {
  if (!cells_) return Split::quarters;
  const Variance u = variance_between(std::span(columns_).first(cells_->columns));
  const Variance v = variance_between(std::span(rows_).first(cells_->rows));
  if (u.of_means - sure * noise * u.share_of_noise > worth_slabs * v.of_means) return Split::slabs_along_u;
  if (v.of_means - sure * noise * v.share_of_noise > worth_slabs * u.of_means) return Split::slabs_along_v;
  return Split::quarters;
}

Split AxisContrast::along_outline(const PatchShape& patch, std::uint16_t hidden) {
  AxisContrast hiding(patch);
  for (int o = 0; o < strata_per_patch; ++o) hiding.add(o, hidden >> o & 1);
  return hiding.best_split(0);
}

}  // namespace alvor
