#include "radiosity/rays/direction_guide.h"

#include "radiosity/rays/unit_disk.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace alvor {

namespace {

constexpr std::size_t side = DirectionGuide::side, cells = DirectionGuide::cells;
// Share of the rays that is cosine-distributed whatever was found, so that a ray counts for at most four. Chosen.
constexpr double unguided_share = 0.25;
constexpr double most_code = 255;
// Sum of weights below which the light around a cell is not known well enough, and that of all rays is taken. Chosen.
constexpr double few_rays = 4;

}  // namespace

DirectionGuide::Warp::Warp(const DirectionGuide& guide) : codes_(guide.codes()) {
  assert(!guide.is_none());
  for (std::size_t c = 0; c < cells; ++c) column_sum_[c / side] += codes_[c];
  for (const std::uint32_t sum : column_sum_) sum_ += sum;
}

DirectionGuide::Drawn DirectionGuide::Warp::draw(Uv at) const {
  double left = at.u * sum_;
  std::size_t column = 0;
  for (; column + 1 < side && left >= column_sum_[column]; ++column) left -= column_sum_[column];
  const double u = std::min(left / column_sum_[column], 1.0);
  left = at.v * column_sum_[column];
  const std::uint8_t* const codes = &codes_[side * column];
  std::size_t row = 0;
  for (; row + 1 < side && left >= codes[row]; ++row) left -= codes[row];
  const double v = std::min(left / codes[row], 1.0);
  const DiskPoint d = concentric_disk({(double(column) + u) / side, (double(row) + v) / side});
  return {{d.x, d.y, std::sqrt(std::max(1e-12, 1 - d.x * d.x - d.y * d.y))}, sum_ / (double(cells) * codes[row])};
}

void GuideBuilder::add(Vec3 direction, double light, double weight) {
  const double squared_length = dot(direction, direction);
  if (!(direction.z > 0) || !(squared_length > 0)) return;
  const double scale = 1 / std::sqrt(squared_length);
  const Uv at = square_of_disk({scale * direction.x, scale * direction.y});
  const auto place = [](double x) { return std::min(static_cast<std::size_t>(std::max(0.0, x * side)), side - 1); };
  for (Moments* const moments : {&cells_[side * place(at.u) + place(at.v)], &all_}) {
    moments->count += weight;
    moments->sum += weight * light;
    moments->squares += weight * light * light;
  }
}

/// Returns the variance of the light in and around each cell. Neighbours over the edge of the square are opposite each other at
/// the horizon, where a cell has none.
std::array<double, cells> GuideBuilder::variances() const {
  const auto variance = [](const Moments& m) { return std::max(0.0, m.squares / m.count - m.sum * m.sum / (m.count * m.count)); };
  std::array<double, cells> all;
  for (std::size_t c = 0; c < cells; ++c) {
    Moments around;
    for (std::size_t i = std::max<std::size_t>(c / side, 1) - 1; i < std::min(c / side + 2, side); ++i)
      for (std::size_t j = std::max<std::size_t>(c % side, 1) - 1; j < std::min(c % side + 2, side); ++j) {
        const Moments& near = cells_[side * i + j];
        around.count += near.count, around.sum += near.sum, around.squares += near.squares;
      }
    all[c] = variance(around.count < few_rays ? all_ : around);
  }
  return all;
}

DirectionGuide GuideBuilder::guide(double least_gain) const {
  if (all_.count < few_rays) return {};
  const auto variance = variances();
  double mean_deviation = 0, unguided = 0;
  for (const double v : variance) mean_deviation += std::sqrt(v) / cells, unguided += v;
  if (!(mean_deviation > 0)) return {};
  double guided = 0, most = 0;
  std::array<double, cells> density;
  for (std::size_t c = 0; c < cells; ++c) {
    density[c] = unguided_share + (1 - unguided_share) * std::sqrt(variance[c]) / mean_deviation;
    guided += variance[c] / density[c];
    most = std::max(most, density[c]);
  }
  if (unguided < least_gain * guided) return {};
  DirectionGuide::Codes codes;
  for (std::size_t c = 0; c < cells; ++c)
    codes[c] = static_cast<std::uint8_t>(std::clamp(std::ceil(most_code * density[c] / most), 1.0, most_code));
  return DirectionGuide(codes);
}

}  // namespace alvor
