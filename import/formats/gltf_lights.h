#pragma once
// Reads the lights of glTF files (KHR_lights_punctual).

#include "import/formats/placement.h"
#include "import/formats/tiny_gltf.h"
#include "meshing/scene.h"

#include <cstddef>
#include <string>
#include <vector>

namespace alvor {

/// Collects the lights that hang from the nodes of one model. Intensities are cd and lx, so the scene is photometric.
class GltfLights {
 public:
  explicit GltfLights(const tinygltf::Model& model) : model_(model) {}

  /// Appends the light of a node, if it has one, at its place. A `radius` (metres) in the extras of the light or of the node
  /// makes it a sphere. Throws ImportError that names the node if its light is not in the file or of an unknown type.
  void add(const tinygltf::Node& node, std::size_t index, const Placement& placement, Scene& scene);
  /// Appends one sentence for each kind of thing that was not taken as the file has it.
  void append_warnings(std::vector<std::string>& warnings) const;

 private:
  const tinygltf::Model& model_;
  std::size_t lights_ = 0, ranges_ = 0, negative_ = 0;
};

}  // namespace alvor
