#pragma once
// Reads the luminaires of glTF files (EXT_lights_ies).

#include "import/base/scene_files.h"
#include "import/formats/placement.h"
#include "import/formats/tiny_gltf.h"
#include "import/photometry/luminaire_file.h"
#include "meshing/scene.h"

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace alvor {

/// Collects the luminaires that hang from the nodes of one model. Their photometric files are beside the scene, in buffer views,
/// or data URIs. They shine from the luminous opening that the file tells; the extension would allow a point.
class GltfLuminaires {
 public:
  GltfLuminaires(const tinygltf::Model& model, SceneFiles& files) : model_(model), files_(files) {}

  /// Appends the luminaire of a node, if it has one, at its place. Throws ImportError that names the node or the photometric
  /// file, and MissingFileError.
  void add(const tinygltf::Node& node, std::size_t index, const Placement& placement, Scene& scene);
  /// Returns one sentence for each oddity of the photometric files.
  const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  const LuminaireFile& profile(int which, const std::string& place);
  std::string bytes_of(const tinygltf::Value& profile, const std::string& place);

  const tinygltf::Model& model_;
  SceneFiles& files_;
  std::map<int, LuminaireFile> known_;
  std::vector<std::string> warnings_;
};

}  // namespace alvor
