#include "meshing/texture_mean.h"

#include <algorithm>
#include <cmath>

namespace alvor {

namespace {

constexpr double unit = 0x1p-19;  // of values: sums over 8191 texels stay below 2^32
constexpr std::uint32_t one = 1u << 19, opaque = 255;
// Texels that the outline of a polygon may cross.
constexpr double most_crossed = 65536;

double signed_area(std::span<const TexelPoint> polygon) {
  double twice = 0;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const TexelPoint a = polygon[k], b = polygon[(k + 1) % polygon.size()];
    twice += (a.x - polygon[0].x) * (b.y - polygon[0].y) - (b.x - polygon[0].x) * (a.y - polygon[0].y);
  }
  return twice / 2;
}

/// Returns the length of the outline as the number of grid lines that it crosses.
double outline(std::span<const TexelPoint> polygon) {
  double length = 0;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const TexelPoint a = polygon[k], b = polygon[(k + 1) % polygon.size()];
    length += std::abs(b.x - a.x) + std::abs(b.y - a.y);
  }
  return length;
}

std::int64_t floor_of(double x) { return static_cast<std::int64_t>(std::floor(x)); }

/// Returns the quotient rounded down.
std::int64_t floor_of(std::int64_t x, std::int64_t y) { return x / y - (x % y < 0); }

/// Returns the surface of these means, in `unit`s, of reflectance times opacity and of opacity.
MeanSurface mean_of(const std::array<double, 4>& mean) {
  const double cover = std::clamp(unit * mean[3], 0.0, 1.0);
  if (cover == 0) return {{}, 0};
  const Rgb reflectance = (unit / cover) * Rgb{mean[0], mean[1], mean[2]};
  return {lower(upper(reflectance, {}), Rgb{1, 1, 1}), cover};
}

/// Counts where a line that starts at `from` and goes by `way` crosses whole numbers, as shares of the way.
class Crossings {
 public:
  Crossings(double from, double way)
      : from_(from), way_(way), next_(way > 0 ? std::floor(from) + 1 : std::ceil(from) - 1), step_(way > 0 ? 1 : -1) {}
  /// Returns the next crossing; 1 or more if there is none.
  double next() const { return way_ == 0 ? 2 : (next_ - from_) / way_; }
  void pass() { next_ += step_; }

 private:
  double from_, way_, next_, step_;
};

}  // namespace

TextureMean::TextureMean(const ColourImage& image, double (*of_texel)(std::uint8_t))
    : image_(image), mean_(mean_surface(image, of_texel)), bands_(image.bytes_a_texel()), sum_before_(image.byte_count()) {
  for (std::size_t value = 0; value < value_of_byte_.size(); ++value)
    value_of_byte_[value] = static_cast<std::uint32_t>(std::lround(of_texel(static_cast<std::uint8_t>(value)) / unit));
  for (std::uint32_t row = 0; row < image.rows; ++row) {
    std::array<std::uint32_t, 4> sum{};
    for (std::uint32_t column = 0; column < image.columns; ++column) {
      std::copy_n(sum.begin(), bands_, &sum_before_[bands_ * (std::size_t{row} * image.columns + column)]);
      const auto value = value_of(column, row);
      for (std::size_t band = 0; band < bands_; ++band) sum[band] += value[band];
    }
  }
}

std::array<std::uint32_t, 4> TextureMean::value_of(std::uint32_t column, std::uint32_t row) const {
  const std::uint8_t* const texel = image_.texel(column, row);
  std::array<std::uint32_t, 4> value{value_of_byte_[texel[0]], value_of_byte_[texel[1]], value_of_byte_[texel[2]], one};
  if (!image_.has_opacity) return value;
  for (std::uint32_t& band : value) band = static_cast<std::uint32_t>((std::uint64_t{band} * texel[3] + opaque / 2) / opaque);
  return value;
}

/// Returns the sums before a texel in its row.
std::array<std::uint32_t, 4> TextureMean::sum_before(std::uint32_t column, std::uint32_t row) const {
  std::array<std::uint32_t, 4> sum{0, 0, 0, column * one};
  std::copy_n(&sum_before_[bands_ * (std::size_t{row} * image_.columns + column)], bands_, sum.begin());
  return sum;
}

TextureMean::Sums TextureMean::total_of(std::uint32_t row) const {
  const std::uint32_t last = image_.columns - 1;
  const auto before = sum_before(last, row), value = value_of(last, row);
  Sums total;
  for (std::size_t band = 0; band < total.size(); ++band) total[band] = static_cast<double>(before[band]) + value[band];
  return total;
}

TextureMean::Column TextureMean::column(std::int64_t index, std::uint32_t row, Wrap wrap) const {
  const std::int64_t n = image_.columns, period = wrap == Wrap::mirror ? 2 * n : n;
  const std::uint32_t texel = wrapped(index, image_.columns, wrap);
  const auto value = value_of(texel, row), before = sum_before(texel, row);
  const Sums total = wrap == Wrap::clamp ? Sums{} : total_of(row);
  Column result;
  for (std::size_t band = 0; band < total.size(); ++band) {
    const double own = value[band];
    result.value[band] = own;
    if (wrap == Wrap::clamp) {
      result.before[band] = before[band] + own * static_cast<double>(index - std::int64_t{texel});
      continue;
    }
    const std::int64_t periods = floor_of(index, period), rest = index - periods * period;
    const double whole = static_cast<double>(periods) * total[band] * (wrap == Wrap::mirror ? 2 : 1);
    result.before[band] = whole + (rest < n ? before[band] : 2 * total[band] - before[band] - own);
  }
  return result;
}

/// Adds the integral of the rows' running sums over y along an edge.
void TextureMean::add_edge(TexelPoint from, TexelPoint to, Wrap across, Wrap down, Sums& integral) const {
  const double dx = to.x - from.x, dy = to.y - from.y;
  if (dy == 0) return;
  Crossings columns(from.x, dx), rows(from.y, dy);
  for (double t = 0; t < 1;) {
    const double end = std::min({columns.next(), rows.next(), 1.0}), middle = (t + end) / 2;
    if (end >= columns.next()) columns.pass();
    if (end >= rows.next()) rows.pass();
    if (end <= t) continue;
    const std::int64_t index = floor_of(from.x + middle * dx);
    const std::uint32_t row = wrapped(floor_of(from.y + middle * dy), image_.rows, down);
    const Column texel = column(index, row, across);
    const double into = from.x + middle * dx - static_cast<double>(index);
    for (std::size_t band = 0; band < integral.size(); ++band)
      integral[band] += (end - t) * dy * (texel.before[band] + into * texel.value[band]);
    t = end;
  }
}

MeanSurface TextureMean::over(std::span<const TexelPoint> polygon, Wrap across, Wrap down) const {
  const double area = signed_area(polygon), around = outline(polygon);
  if (around > most_crossed) return mean_;
  if (area == 0) {  // also by rounding, far from the image
    const auto value =
        value_of(wrapped(floor_of(polygon[0].x), image_.columns, across), wrapped(floor_of(polygon[0].y), image_.rows, down));
    return mean_of({double(value[0]), double(value[1]), double(value[2]), double(value[3])});
  }
  // Sums are small, and so exact, near the first texel. Two periods are one of a mirrored image, too.
  const double columns = 2.0 * image_.columns, shift = across == Wrap::clamp ? 0 : columns * std::floor(polygon[0].x / columns);
  const auto near = [&](std::size_t k) { return TexelPoint{polygon[k].x - shift, polygon[k].y}; };
  Sums integral{};
  for (std::size_t k = 0; k < polygon.size(); ++k) add_edge(near(k), near((k + 1) % polygon.size()), across, down, integral);
  for (double& band : integral) band /= area;
  return mean_of(integral);
}

}  // namespace alvor
