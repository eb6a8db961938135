#pragma once
// Cuts a scene into a fixed mesh of elements and patches.

#include "meshing/base_mesh.h"
#include "radiosity/rays/visibility.h"
#include "solution/patch_id.h"

#include <array>
#include <vector>

namespace alvor::bench {

/// A piece of surface that receives light. Local coordinates, see LocalFrame.
struct Element {
  PatchId id;
  Vec3 centre, normal;
  double area = 0;
  Rgb reflectance;
  std::uint32_t patch = 0;
};

/// A patch that shoots, from four places.
struct ShootingSource {
  std::array<Vec3, 4> places;
  Vec3 normal;
  double area = 0;
  Rgb emission;
};

struct FixedMesh {
  std::vector<Element> elements;  ///< sorted by id
  std::vector<ShootingSource> patches;
};

/// Cuts each root evenly until no edge is longer than `longest_edge`, metres. A patch is the parent of four elements, or a root
/// that was not cut.
FixedMesh cut_evenly(const BaseMesh& mesh, double longest_edge, const LocalFrame& frame);

}  // namespace alvor::bench
