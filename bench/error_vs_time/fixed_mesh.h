#pragma once
// Elements and the patches that they belong to.

#include "meshing/base_mesh.h"
#include "radiosity/rays/visibility.h"
#include "solution/patch_id.h"

#include <array>
#include <vector>

namespace alvor::bench {

/// Receives. Local coordinates, see LocalFrame.
struct Element {
  PatchId id;
  Vec3 centre, normal;
  double area = 0;
  Rgb reflectance;
  std::uint32_t patch = 0;
};

/// Shoots from four places.
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

/// Each root is cut evenly until no edge is longer than `longest_edge`, metres; a patch is the parent of four elements, or a root
/// that was not cut.
FixedMesh cut_evenly(const BaseMesh& mesh, double longest_edge, const LocalFrame& frame);

}  // namespace alvor::bench
