#pragma once
// Pictures of illuminance on the plan of a room.

#include "client/picture/colour_scale.h"
#include "client/picture/png_file.h"
#include "client/report/illuminance.h"
#include "meshing/light.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace alvor {

/// Values at the points of a grid, interpolated in between.
class GridField {
 public:
  /// `values` are those of the grid's points, in their order; a point without a value takes no part. Borrows the grid.
  GridField(const Room& room, const WorkGrid& grid, std::span<const std::optional<double>> values);
  /// Returns the value at a place of the plan, bilinear between the points around it and constant beyond the outermost; nothing
  /// if none of these has a value.
  std::optional<double> at(double along_u, double along_v) const;

 private:
  const WorkGrid& grid_;
  double first_u_, first_v_;                   ///< of the point in column 0 and row 0
  std::vector<std::optional<double>> values_;  ///< of all columns and rows
};

struct IsoluxPlan {
  const Room& room;
  const WorkGrid& grid;
  std::span<const std::optional<double>> values;
  std::span<const Light* const> luminaires;  ///< marked by their outline, or a cross
  std::string unit;                          ///< "lx"
  std::optional<ColourScale> scale;          ///< empty: automatic
};

/// Returns the plan in colours, with curves of equal values at those of the legend, the values of the grid's points, the
/// luminaires, and a bar of metres.
Image draw_isolux(const IsoluxPlan& plan);

}  // namespace alvor
