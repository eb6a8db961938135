#include "client/report/position_index.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <tuple>

namespace alvor {

namespace {

constexpr std::size_t rows = 31, columns = 20;
constexpr double step = 0.1;  // of both ratios
constexpr float hidden = 0;   // behind the observer's brow

// By the ratio of the distance beside the line of sight to that ahead, from 0 to 3 (rows), and the ratio of the height above it
// to that ahead, from 0 to 1.9 (columns).
constexpr std::array<std::array<float, columns>, rows> indices{{
    {1.00F, 1.26F, 1.53F, 1.90F,  2.35F,  2.86F,  3.50F,  4.20F,  5.00F,  6.00F,
     7.00F, 8.10F, 9.25F, 10.35F, 11.70F, 13.15F, 14.70F, 16.20F, hidden, hidden},
    {1.05F, 1.22F, 1.45F, 1.80F,  2.20F,  2.75F,  3.40F,  4.10F,  4.80F,  5.80F,
     6.80F, 8.00F, 9.10F, 10.30F, 11.60F, 13.00F, 14.60F, 16.10F, hidden, hidden},
    {1.12F, 1.30F, 1.50F, 1.80F, 2.20F,  2.66F,  3.18F,  3.88F,  4.60F,  5.50F,
     6.50F, 7.60F, 8.75F, 9.85F, 11.20F, 12.70F, 14.00F, 15.70F, hidden, hidden},
    {1.22F, 1.38F, 1.60F, 1.87F, 2.25F,  2.70F,  3.25F,  3.90F,  4.60F,  5.45F,
     6.45F, 7.40F, 8.40F, 9.50F, 10.85F, 12.10F, 13.70F, 15.00F, hidden, hidden},
    {1.32F, 1.47F, 1.70F, 1.96F, 2.35F,  2.80F,  3.30F,  3.90F,  4.60F,  5.40F,
     6.40F, 7.30F, 8.30F, 9.40F, 10.60F, 11.90F, 13.20F, 14.60F, 16.00F, hidden},
    {1.43F, 1.60F, 1.82F, 2.10F, 2.48F,  2.91F,  3.40F,  3.98F,  4.70F,  5.50F,
     6.40F, 7.30F, 8.30F, 9.40F, 10.50F, 11.75F, 13.00F, 14.40F, 15.70F, hidden},
    {1.55F, 1.72F, 1.98F, 2.30F, 2.65F,  3.10F,  3.60F,  4.10F,  4.80F,  5.50F,
     6.40F, 7.35F, 8.40F, 9.40F, 10.50F, 11.70F, 13.00F, 14.10F, 15.40F, hidden},
    {1.70F, 1.88F, 2.12F, 2.48F, 2.87F,  3.30F,  3.78F,  4.30F,  4.88F,  5.60F,
     6.50F, 7.40F, 8.50F, 9.50F, 10.50F, 11.70F, 12.85F, 14.00F, 15.20F, hidden},
    {1.82F, 2.00F, 2.32F, 2.70F, 3.08F,  3.50F,  3.92F,  4.50F,  5.10F,  5.75F,
     6.60F, 7.50F, 8.60F, 9.50F, 10.60F, 11.75F, 12.80F, 14.00F, 15.10F, hidden},
    {1.95F, 2.20F, 2.54F, 2.90F, 3.30F,  3.70F,  4.20F,  4.75F,  5.30F,  6.00F,
     6.75F, 7.70F, 8.70F, 9.65F, 10.75F, 11.80F, 12.90F, 14.00F, 15.00F, 16.00F},
    {2.11F, 2.40F, 2.75F, 3.10F, 3.50F,  3.91F,  4.40F,  5.00F,  5.60F,  6.20F,
     7.00F, 7.90F, 8.80F, 9.75F, 10.80F, 11.90F, 12.95F, 14.00F, 15.00F, 16.00F},
    {2.30F, 2.55F, 2.92F, 3.30F, 3.72F,  4.20F,  4.70F,  5.25F,  5.80F,  6.55F,
     7.20F, 8.15F, 9.00F, 9.90F, 10.95F, 12.00F, 13.00F, 14.00F, 15.00F, 16.00F},
    {2.40F, 2.75F, 3.12F, 3.50F,  3.90F,  4.35F,  4.85F,  5.50F,  6.05F,  6.70F,
     7.50F, 8.30F, 9.20F, 10.00F, 11.02F, 12.10F, 13.10F, 14.00F, 15.00F, 16.00F},
    {2.55F, 2.90F, 3.30F, 3.70F,  4.20F,  4.65F,  5.20F,  5.70F,  6.30F,  7.00F,
     7.70F, 8.55F, 9.35F, 10.20F, 11.20F, 12.25F, 13.20F, 14.00F, 15.00F, 16.00F},
    {2.70F, 3.10F, 3.50F, 3.90F,  4.35F,  4.85F,  5.35F,  5.85F,  6.50F,  7.25F,
     8.00F, 8.70F, 9.50F, 10.40F, 11.40F, 12.40F, 13.25F, 14.05F, 15.00F, 16.00F},
    {2.85F, 3.15F, 3.65F, 4.10F,  4.55F,  5.00F,  5.50F,  6.20F,  6.80F,  7.50F,
     8.20F, 8.85F, 9.70F, 10.55F, 11.50F, 12.50F, 13.30F, 14.05F, 15.02F, 16.00F},
    {2.95F, 3.40F, 3.80F, 4.25F,  4.75F,  5.20F,  5.75F,  6.30F,  7.00F,  7.65F,
     8.40F, 9.00F, 9.80F, 10.80F, 11.75F, 12.60F, 13.40F, 14.20F, 15.10F, 16.00F},
    {3.10F, 3.55F, 4.00F,  4.50F,  4.90F,  5.40F,  5.95F,  6.50F,  7.20F,  7.80F,
     8.50F, 9.20F, 10.00F, 10.85F, 11.85F, 12.75F, 13.45F, 14.20F, 15.10F, 16.00F},
    {3.25F, 3.70F, 4.20F,  4.65F,  5.10F,  5.60F,  6.10F,  6.75F,  7.40F,  8.00F,
     8.65F, 9.35F, 10.10F, 11.00F, 11.90F, 12.80F, 13.50F, 14.20F, 15.10F, 16.00F},
    {3.43F, 3.86F, 4.30F,  4.75F,  5.20F,  5.70F,  6.30F,  6.90F,  7.50F,  8.17F,
     8.80F, 9.50F, 10.20F, 11.00F, 12.00F, 12.82F, 13.55F, 14.20F, 15.10F, 16.00F},
    {3.50F, 4.00F, 4.50F,  4.90F,  5.35F,  5.80F,  6.40F,  7.10F,  7.70F,  8.30F,
     8.90F, 9.60F, 10.40F, 11.10F, 12.00F, 12.85F, 13.60F, 14.30F, 15.10F, 16.00F},
    {3.60F, 4.17F, 4.65F,  5.05F,  5.50F,  6.00F,  6.60F,  7.20F,  7.82F,  8.45F,
     9.00F, 9.75F, 10.50F, 11.20F, 12.10F, 12.90F, 13.70F, 14.35F, 15.10F, 16.00F},
    {3.75F, 4.25F, 4.72F,  5.20F,  5.60F,  6.10F,  6.70F,  7.35F,  8.00F,  8.55F,
     9.15F, 9.85F, 10.60F, 11.30F, 12.10F, 12.90F, 13.70F, 14.40F, 15.15F, 16.00F},
    {3.85F, 4.35F, 4.80F,  5.25F,  5.70F,  6.22F,  6.80F,  7.40F,  8.10F,  8.65F,
     9.30F, 9.90F, 10.70F, 11.40F, 12.20F, 12.95F, 13.70F, 14.40F, 15.20F, 16.00F},
    {3.95F, 4.40F,  4.90F,  5.35F,  5.80F,  6.30F,  6.90F,  7.50F,  8.20F,  8.80F,
     9.40F, 10.00F, 10.80F, 11.50F, 12.25F, 13.00F, 13.75F, 14.45F, 15.20F, 16.00F},
    {4.00F, 4.50F,  4.95F,  5.40F,  5.85F,  6.40F,  6.95F,  7.55F,  8.25F,  8.85F,
     9.50F, 10.05F, 10.85F, 11.55F, 12.30F, 13.00F, 13.80F, 14.50F, 15.25F, 16.00F},
    {4.07F, 4.55F,  5.05F,  5.47F,  5.95F,  6.45F,  7.00F,  7.65F,  8.35F,  8.95F,
     9.55F, 10.10F, 10.90F, 11.60F, 12.32F, 13.00F, 13.80F, 14.50F, 15.25F, 16.00F},
    {4.10F, 4.60F,  5.10F,  5.53F,  6.00F,  6.50F,  7.05F,  7.70F,  8.40F,  9.00F,
     9.60F, 10.16F, 10.92F, 11.63F, 12.35F, 13.00F, 13.80F, 14.50F, 15.25F, 16.00F},
    {4.15F, 4.62F,  5.15F,  5.56F,  6.05F,  6.55F,  7.08F,  7.73F,  8.45F,  9.05F,
     9.65F, 10.20F, 10.95F, 11.65F, 12.35F, 13.00F, 13.80F, 14.50F, 15.25F, 16.00F},
    {4.20F, 4.65F,  5.17F,  5.60F,  6.07F,  6.57F,  7.12F,  7.75F,  8.50F,  9.10F,
     9.70F, 10.23F, 10.95F, 11.65F, 12.35F, 13.00F, 13.80F, 14.50F, 15.25F, 16.00F},
    {4.22F, 4.67F,  5.20F,  5.65F,  6.12F,  6.60F,  7.15F,  7.80F,  8.55F,  9.12F,
     9.70F, 10.23F, 10.95F, 11.65F, 12.35F, 13.00F, 13.80F, 14.50F, 15.25F, 16.00F},
}};

}  // namespace

std::optional<double> position_index(double ahead, double above, double beside) {
  if (!(ahead > 0)) return std::nullopt;
  const double row = std::abs(beside) / ahead / step, column = std::abs(above) / ahead / step;
  if (!(row <= rows - 1 && column <= columns - 1)) return std::nullopt;
  const auto r = std::min(static_cast<std::size_t>(row), rows - 2), c = std::min(static_cast<std::size_t>(column), columns - 2);
  const double v = row - static_cast<double>(r), u = column - static_cast<double>(c);
  double sum = 0;
  for (const auto& [dr, dc, weight] : {std::tuple(0, 0, (1 - u) * (1 - v)), std::tuple(0, 1, u * (1 - v)),
                                       std::tuple(1, 0, (1 - u) * v), std::tuple(1, 1, u * v)}) {
    const float index = indices[r + static_cast<std::size_t>(dr)][c + static_cast<std::size_t>(dc)];
    if (weight > 0 && index == hidden) return std::nullopt;
    sum += weight * index;
  }
  return sum;
}

}  // namespace alvor
