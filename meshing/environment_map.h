#pragma once
// Radiance from all directions around a scene, as photographs of surroundings give it.

#include "meshing/vec3.h"
#include "solution/rgb.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace alvor {

struct Light;

/// A grid of latitudes and longitudes over all directions. Row r covers the angles from pi r / rows to pi (r + 1) / rows from the
/// zenith. Column c covers the longitudes from 2 pi c / columns - pi to 2 pi (c + 1) / columns - pi, counted from the middle of
/// the image to the right. Directions have the coordinates x: ahead, to the middle of the image; y: right; z: up.
struct SphereGrid {
  std::uint32_t columns = 0, rows = 0;  ///< > 0

  std::size_t size() const { return std::size_t{columns} * rows; }
  /// Returns the solid angle of one pixel of a row, steradians. Exact.
  double solid_angle(std::uint32_t row) const;
  /// Returns the integral of the direction over a pixel: its dot product with a normal is the irradiance that a pixel of radiance
  /// 1 brings, if all of it is above the horizon. Exact.
  Vec3 direction_sum(std::uint32_t row, std::uint32_t column) const;
  /// Returns the direction of a place in the image, unit. `u` and `v` count columns from the left and rows from the top.
  Vec3 direction_at(double u, double v) const;
  /// Returns the index (row first) of the pixel that holds a direction. Requires: a unit vector.
  std::size_t pixel_at(Vec3 direction) const;

  friend bool operator==(const SphereGrid&, const SphereGrid&) = default;
};

/// Radiance by direction, constant within each pixel of the grid. Immutable once made; lights share it.
struct EnvironmentMap {
  static constexpr std::uint32_t most_columns = 256, most_rows = 128;
  SphereGrid grid;
  std::vector<RgbF> pixels;  ///< W/m2 sr or cd/m2, in [0, 1e30]; row by row from the zenith

  /// Returns the integral of the radiance over all directions, W/m2: no surface receives more.
  Rgb total() const;

  friend bool operator==(const EnvironmentMap&, const EnvironmentMap&) = default;
};

/// Returns why the map cannot be used; nothing if it can.
std::optional<std::string> fault_in(const EnvironmentMap& map);

/// The axes of an environment in the scene, unit: `ahead` to the middle of its image, and the right and upper sides there.
struct EnvironmentAxes {
  Vec3 ahead, right, up;
  /// Requires: an environment; !fault_in(environment).
  explicit EnvironmentAxes(const Light& environment);
  Vec3 to_grid(Vec3 in_scene) const { return {dot(in_scene, ahead), dot(in_scene, right), dot(in_scene, up)}; }
  Vec3 to_scene(Vec3 in_grid) const { return in_grid.x * ahead + in_grid.y * right + in_grid.z * up; }
};

/// Averages an image on a grid onto a coarser one. Each pixel counts by the solid angle of its overlap, so the integral over all
/// directions is kept.
class EnvironmentReduction {
 public:
  EnvironmentReduction(SphereGrid from, SphereGrid to);
  /// Takes the next row of the image. Requires: three floats per column of `from`.
  void add_row(std::span<const float> rgb);
  /// Returns the averages. Requires: all rows were added.
  EnvironmentMap take();

 private:
  SphereGrid from_;
  std::uint32_t next_row_ = 0;
  std::vector<Rgb> sums_, row_;
  EnvironmentMap map_;
};

/// Returns the map itself if it has at most so many columns and rows; else its averages on a grid of that size.
EnvironmentMap reduced(const EnvironmentMap& map, std::uint32_t most_columns, std::uint32_t most_rows);

}  // namespace alvor
