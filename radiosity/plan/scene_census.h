#pragma once
// What a scene is made of, in figures.

#include "meshing/base_mesh.h"

#include <cstddef>

namespace alvor {

/// Counts over the faces of a mesh and the materials that they have.
struct SceneCensus {
  explicit SceneCensus(const BaseMesh& mesh);

  std::size_t faces = 0, emitting_faces = 0, two_sided_faces = 0;  ///< two sides count once
  std::size_t materials = 0, grey_materials = 0, reflecting_materials = 0;
  double largest_reflectance = 0;      ///< of any band
  double emitting_share = 0;           ///< of all area
  const Material* coloured = nullptr;  ///< the first that is not grey

  bool is_lit() const { return emitting_faces > 0; }
};

}  // namespace alvor
