#pragma once
// Progressive shooting on a fixed mesh, as textbooks describe it.

#include "meshing/base_mesh.h"
#include "solution/leaf_value.h"

#include <cstdint>
#include <vector>

namespace alvor::bench {

struct FixedMeshOptions {
  int cells = 16;                 ///< limit of an element's edges: the scene's longest side over this
  double unshot_fraction = 1e-3;  ///< shoots until this fraction of the emitted power is unshot
  double time_limit_s = 30;
};

struct FixedMeshSolution {
  std::vector<LeafValue> leaves;  ///< sorted by id
  std::uint64_t rays = 0;
  double cpu_s = 0, wall_s = 0;
  bool is_done = false;  ///< false: the time limit ended it
};

/// Solves by progressive refinement (Cohen, Chen, Wallace & Greenberg 1988) with ray-traced form factors (Wallace, Elmquist &
/// Haines 1989). Faces are cut into elements, which receive; patches of four elements shoot, largest unshot power first. A shot
/// sends a shadow ray from the centre of each element to four places of the patch, weighted as small disks; nothing is stored.
/// Runs on the calling thread, sixteen rays at a time.
FixedMeshSolution shoot_on_fixed_mesh(const BaseMesh& mesh, const FixedMeshOptions& options);

}  // namespace alvor::bench
