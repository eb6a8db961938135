#include "client/report/illuminance.h"

#include "client/picture/units.h"
#include "meshing/mesh_area.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace alvor {

namespace {

constexpr std::size_t directions = 8;  // of the vertical planes whose mean is the cylindrical illuminance

Vec3 place_of(const Room& room, const WorkPoint& point, double height) {
  constexpr double least = 1e-3;  // metres: on the floor itself, rays would begin in its plane
  return room.frame.place(point.along_u, point.along_v, room.floor_at(point.along_u, point.along_v) + std::max(least, height));
}

/// Sets the light on vertical planes at a point; nothing if it lies inside a solid.
void measure_vertical(const PlanFrame& frame, Vec3 point, const LightMeter& meter, std::uint64_t stream, PointLight& light) {
  Measured sum;
  double squares = 0;
  for (std::size_t n = 0; n < directions; ++n) {
    const double angle = 2 * std::numbers::pi * static_cast<double>(n) / directions;
    const auto value = meter.at(point, std::cos(angle) * frame.u + std::sin(angle) * frame.v, stream + n, 1.0 / directions);
    if (!value) return;
    if (n % 2 == 0) light.vertical[n / 2] = value->value;
    sum.value += value->value / directions;
    squares += value->error * value->error / (directions * directions);
  }
  light.cylindrical = Measured{sum.value, std::sqrt(squares)};
}

}  // namespace

std::optional<PlaneStatistics> statistics_of(std::span<const Measured> values) {
  if (values.empty()) return std::nullopt;
  PlaneStatistics all{values.size(), {}, values.front().value, values.front().value};
  for (const Measured& each : values) {
    all.mean.value += each.value / static_cast<double>(values.size());
    all.mean.error += each.error / static_cast<double>(values.size());  // as if all erred alike
    all.minimum = std::min(all.minimum, each.value);
    all.maximum = std::max(all.maximum, each.value);
  }
  return all;
}

std::optional<Measured> LightMeter::at(Vec3 point, Vec3 normal, std::uint64_t stream, double effort) const {
  const auto gathered = gatherer.gather(point, normal, stream, effort);
  if (!gathered) return std::nullopt;
  return Measured{one_number(gathered->irradiance, quantity), std::hypot(gathered->standard_error, gathered->told_error)};
}

std::vector<std::optional<Measured>> horizontal_light_on(const Room& room, const WorkGrid& grid, double height,
                                                         const LightMeter& meter) {
  std::vector<std::optional<Measured>> lights(grid.points.size());
  tbb::parallel_for(std::size_t{0}, grid.points.size(), [&](std::size_t n) {
    lights[n] = meter.at(place_of(room, grid.points[n], height), room.frame.up, n * (directions + 1));
  });
  return lights;
}

std::vector<PointLight> light_on(const Room& room, const WorkGrid& grid, const PlaneHeights& heights, const LightMeter& meter) {
  const auto horizontal = horizontal_light_on(room, grid, heights.work, meter);
  std::vector<PointLight> lights(grid.points.size());
  tbb::parallel_for(std::size_t{0}, grid.points.size(), [&](std::size_t n) {
    lights[n].horizontal = horizontal[n];
    measure_vertical(room.frame, place_of(room, grid.points[n], heights.face), meter, n * (directions + 1) + 1, lights[n]);
  });
  return lights;
}

std::optional<double> told_relative_error(const DisplayMesh& mesh) {
  if (mesh.errors.empty()) return std::nullopt;
  double squares = 0, light = 0, area = 0;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    const double size = area_of(mesh, t);
    const double error = error_at(mesh, t, 1.0 / 3, 1.0 / 3);
    squares += size * error * error;
    light += size * widen(mesh.irradiance[a] + mesh.irradiance[b] + mesh.irradiance[c]).mean() / 3;
    area += size;
  }
  if (!(light > 0)) return std::nullopt;
  return std::sqrt(squares / area) / (light / area);
}

}  // namespace alvor
