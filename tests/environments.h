#pragma once
// Environments that tests share.

#include "meshing/light.h"

#include <memory>

namespace alvor::test {

/// Returns an environment whose middle looks along x, y up, with radiance_at(direction in the scene) in the middle of each pixel.
template <class RadianceAt>
Light environment(SphereGrid grid, RadianceAt&& radiance_at) {
  Light light;
  light.name = "surroundings";
  light.kind = LightKind::environment;
  light.intensity = {1, 1, 1};
  light.direction = {0, -1, 0};
  const EnvironmentAxes axes(light);
  auto map = std::make_shared<EnvironmentMap>();
  map->grid = grid;
  for (std::uint32_t row = 0; row < grid.rows; ++row)
    for (std::uint32_t column = 0; column < grid.columns; ++column)
      map->pixels.push_back(narrow(radiance_at(axes.to_scene(grid.direction_at(column + 0.5, row + 0.5)))));
  light.environment = std::move(map);
  return light;
}

}  // namespace alvor::test
