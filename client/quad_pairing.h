#pragma once

#include "meshing/scene.h"

namespace alvor {

/// Importers cut quads in two; this joins them again. Two triangles of one material that share an edge (by exact position) become
/// a quad where they lie in one plane and make a strictly convex outline with corners of 20 to 160 degrees. Consecutive triangles
/// and square corners come first; each triangle is used once. The quad takes the place of the first of its triangles and begins
/// at its first corner. O(n log n).
/// Requires: !find_fault(scene).
void pair_triangles(Scene& scene);

}  // namespace alvor
