#pragma once
// Tells along which axis of a patch its light changes.

#include "meshing/patch_place.h"

#include <array>
#include <cstdint>
#include <span>

namespace alvor {

/// Values at strata of a patch, added one by one: how their means differ between columns along u, and between rows along v.
class AxisContrast {
 public:
  explicit AxisContrast(const PatchShape& patch);

  void add(int stratum, double value);
  /// Returns the split that leaves least variance where the light changes linearly along each axis: slabs divide the variance
  /// along their axis by 16 and leave that along the other; quarters divide both by 4. So slabs are better if the variance along
  /// their axis is more than 4 times the other's. `noise` is the variance of each value that says nothing of the light.
  Split best_split(double noise) const;
  /// Returns the split that follows the outline of what hides these strata.
  static Split along_outline(const PatchShape& patch, std::uint16_t hidden);

 private:
  struct Line {
    double sum = 0, count = 0;
  };
  using Lines = std::array<Line, strata_per_patch>;
  /// The column and the row of each stratum.
  struct Cells {
    explicit Cells(int strata_along_u);
    std::array<std::uint8_t, strata_per_patch> column, row;
    std::size_t columns, rows;  ///< their numbers
  };
  static const Cells& cells_of(int strata_along_u);
  struct Variance {
    double of_means = 0;        ///< of the means of lines
    double share_of_noise = 0;  ///< of the noise of a value, that the mean of a line has on average
  };
  static Variance variance_between(std::span<const Line> lines);

  const Cells* cells_;  // null: a triangle, which has no slabs
  Lines columns_, rows_;
};

}  // namespace alvor
