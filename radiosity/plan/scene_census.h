#pragma once
// Counts of a scene's faces and materials.

#include "meshing/base_mesh.h"

#include <cstddef>

namespace alvor {

/// Counts of the faces of a mesh and of the materials that its faces use.
struct SceneCensus {
  explicit SceneCensus(const BaseMesh& mesh);

  std::size_t faces = 0, emitting_faces = 0, two_sided_faces = 0, panes = 0;  ///< a face with two sides counts once
  std::size_t materials = 0, grey_materials = 0, reflecting_materials = 0;
  double largest_reflectance = 0;         ///< largest share that any material scatters, to both sides, in any band
  double emitting_share = 0;              ///< share of the area of all sides that emits
  const Material* coloured = nullptr;     ///< the first material that is not grey; null: all are grey
  std::size_t lights = 0;                 ///< lights that are not faces and not black
  const Light* coloured_light = nullptr;  ///< the first of these that is not grey; null: all are grey
  bool has_distant_light = false;
  bool has_cut_emitter = false;  ///< a face that emits has holes

  bool is_lit() const { return emitting_faces + lights > 0; }
};

}  // namespace alvor
