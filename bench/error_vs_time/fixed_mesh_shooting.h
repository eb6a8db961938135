#pragma once
// Progressive shooting as textbooks have it, on a mesh that stays as it is.

#include "meshing/base_mesh.h"
#include "solution/leaf_value.h"

#include <cstdint>
#include <vector>

namespace alvor::bench {

struct FixedMeshOptions {
  int cells = 16;                 ///< no edge of an element is longer than the longest side of the scene over this
  double unshot_fraction = 1e-3;  ///< shoots until no more of the emitted power is unshot
  double time_limit_s = 30;
};

struct FixedMeshSolution {
  std::vector<LeafValue> leaves;  ///< sorted by id
  std::uint64_t rays = 0;
  double cpu_s = 0, wall_s = 0;
  bool is_done = false;  ///< false: the time limit ended it
};

/// Cohen, Chen, Wallace & Greenberg 1988, with the ray traced form factors of Wallace, Elmquist & Haines 1989: faces are cut into
/// elements, which receive, and patches of four elements, which shoot, the largest unshot power first. A shot sends a shadow ray
/// from the centre of each element to four places of the patch, weighted as small disks; nothing is stored. Solves on the
/// calling thread, sixteen rays at a time.
FixedMeshSolution shoot_on_fixed_mesh(const BaseMesh& mesh, const FixedMeshOptions& options);

}  // namespace alvor::bench
