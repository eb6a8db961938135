#pragma once
// The texels of charts: which point of a surface each stands for, and what was solved there.

#include "client/bake/bake.h"
#include "client/bake/chart_pages.h"
#include "client/bake/charts.h"
#include "client/bake/solved_surface.h"
#include "meshing/placement.h"

#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace alvor {

/// A square image of light, rows from the top.
struct LightPage {
  LightPage(int side, bool with_errors)
      : size(side),
        texels(static_cast<std::size_t>(side) * static_cast<std::size_t>(side)),
        errors(with_errors ? texels.size() : 0),
        is_set(texels.size()) {}
  int size;
  std::vector<RgbF> texels;
  std::vector<float> errors;         ///< told error of the irradiance, W/m2, as SolvedSurface::Sample has it; none if not wanted
  std::vector<std::uint8_t> is_set;  ///< whether a chart gave the texel its value

  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(size) + static_cast<std::size_t>(x);
  }
};

/// A chart of a mesh that a node places in the scene.
struct PlacedChart {
  std::span<const Vec3> positions;  ///< of the mesh
  const ChartedMesh* mesh = nullptr;
  const Chart* chart = nullptr;
  Placement placement;
  std::size_t object = 0;
  bool may_show_back = false;  ///< the material has two sides
};

/// Returns the corners of a triangle in the scene.
std::array<Vec3, 3> placed_corners(const PlacedChart& chart, std::uint32_t triangle);
/// Returns the point (1-u-v) a + u b + v c of a triangle in the scene.
Vec3 placed_point(const PlacedChart& chart, std::uint32_t triangle, double u, double v);
/// Returns the normal of a triangle's front in the scene, 0 if it has no area there; a placement that mirrors keeps the front the
/// front.
Vec3 placed_normal(const PlacedChart& chart, std::uint32_t triangle);

/// Returns a chart's size on the surface.
ChartSize size_of(const PlacedChart& chart);
/// Returns the place of a vertex of the charted mesh on its chart's page, in texels from the page's upper left corner.
std::array<double, 2> texel_of(const PlacedChart& chart, const ChartPlace& place, int padding, std::uint32_t vertex);

/// What is written to the texels.
using TexelValue = std::function<Rgb(const SolvedSurface::Sample&)>;

/// The side of a chart that its texels show.
struct ShownSide {
  bool is_back = false;
  bool loses_light = false;  ///< the other side has more than a tenth of this one's light
};
/// Returns the side of a chart that `wanted` says, which is the front if the material has one side.
ShownSide shown_side(const PlacedChart& chart, const SolvedSurface& surface, BakedSide wanted);

/// Sets the texels of a chart's rectangle: those within the chart to the mean of four points, those at its edge to the point that
/// they stand for, those around it to the nearest point of the chart. Points that something covers, as a table's legs do on a
/// floor, count only where all of a texel's are: up to four texels from the light such a texel takes it on, further in it stays
/// dark. Writes only within the rectangle.
void fill(LightPage& page, const PlacedChart& chart, const ChartPlace& place, int padding, bool shows_back,
          const SolvedSurface& surface, const TexelValue& value);

/// Gives each texel of a rectangle that is not set the mean of its set neighbours, `times` times, so that smaller mip levels stay
/// clean.
void spread(LightPage& page, const ChartPlace& within, int times);

}  // namespace alvor
