#pragma once
// Checks that every scene of ours must pass.

#include "import/apart/scene_file.h"
#include "tests/bench/light_walk.h"

#include <gtest/gtest.h>

namespace alvor::test {

inline void expect_clean(const WeldReport& report) {
  EXPECT_EQ(report.degenerate_faces, 0u);
  EXPECT_EQ(report.split_faces, 0u);
  EXPECT_EQ(report.non_manifold_faces, 0u);
}

/// Expects that all light stays on the side of fronts. Exempt are rays that slip through an edge by rounding, and undersides that
/// overhanging cushions lack.
inline void expect_light_stays_inside(const BaseMesh& mesh, int paths_per_lamp) {
  const LightWalk walk = LightWalker(mesh).walk(paths_per_lamp, 8);
  EXPECT_GT(walk.rays, paths_per_lamp);
  EXPECT_LE(walk.left, walk.rays / 10000);
  EXPECT_LE(walk.backs, walk.rays / 2000);
}

}  // namespace alvor::test
