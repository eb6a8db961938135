#pragma once
// Counts the parts of a scene file that Alvor does not support yet.

#include "meshing/scene.h"

#include <cstddef>
#include <string>
#include <vector>

namespace alvor {

/// Counts, by kind, the things that an importer left out or simplified.
struct Unsupported {
  std::size_t point_lights = 0, spot_lights = 0, directional_lights = 0, area_lights = 0, other_lights = 0;
  std::size_t metals = 0, clear_materials = 0, transmission_textures = 0;

  /// Appends one sentence with the count for each kind that is not zero.
  void append_warnings(std::vector<std::string>& warnings) const;
};

/// Returns for each material whether any face uses it.
std::vector<bool> used_materials(const Scene& scene);

}  // namespace alvor
