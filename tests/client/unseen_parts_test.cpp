// Light in places that the origins of rows do not see: slots between solids, and the openings of narrow gaps.

#include "client/verify/probe.h"
#include "meshing/display_mesh.h"
#include "radiosity/solve/solver.h"
#include "solution/solution_log.h"
#include "tests/client/path_tracing.h"

#include <gtest/gtest.h>

#include <vector>

namespace alvor {
namespace {

using test::add_box;
using test::add_polygon;
using test::grey;

/// Returns a closed white room of 1 x 1 x 1 m with a lamp of 0.5 x 0.5 m at its ceiling.
Scene lit_room() {
  Scene scene;
  scene.materials = {grey(0, 0.7), grey(10, 0)};
  add_box(scene, {0, 0, 0}, {1, 1, 1}, true);
  add_polygon(scene, {{0.25, 0.99, 0.25}, {0.75, 0.99, 0.25}, {0.75, 0.99, 0.75}, {0.25, 0.99, 0.75}}, 1);
  return scene;
}

/// Compares a solution with path tracing at single points.
class Comparison {
 public:
  Comparison(const Scene& scene, const SolveOptions& options) : scene_(scene) {
    const BaseMesh mesh(scene);
    SolutionLog log;
    EXPECT_EQ(solve(mesh, options, log, {}).reason, StopReason::tolerance);
    solution_ = build_display_mesh(mesh, log.leaves());
  }
  /// Returns solution over truth at a point.
  double ratio_at(Vec3 place, Vec3 normal) const {
    const ProbePoint asked{place, normal};
    const double found = widen(probe(solution_, std::span(&asked, 1)).front().irradiance).mean();
    const IrradianceEstimate truth = traced(scene_, {place, normal, 0}, 16384);
    return found / truth.mean().mean();
  }

 private:
  Scene scene_;
  DisplayMesh solution_;
};

Scene room_with_slot() {
  Scene scene = lit_room();
  add_box(scene, {0.1, 0, 0.2}, {0.495, 0.01, 0.8}, false);
  add_box(scene, {0.505, 0, 0.2}, {0.9, 0.01, 0.8}, false);
  return scene;
}

void expect_lit_slot(const Comparison& slot, double error) {
  for (const double z : {0.25, 0.4, 0.55, 0.7}) {
    EXPECT_NEAR(slot.ratio_at({0.495, 0.002, z}, {1, 0, 0}), 1, error) << z;
    EXPECT_NEAR(slot.ratio_at({0.505, 0.002, z}, {-1, 0, 0}), 1, error) << z;
    EXPECT_NEAR(slot.ratio_at({0.5, 0, z}, {0, 1, 0}), 1, error) << z;
  }
}

// All origins of large patches of the floor lie under the two slabs. Were these patches taken for hidden, the walls of the slot
// would be half as bright as they are.
TEST(UnseenParts, FloorOfASlotBetweenSolidsIsSeen) { expect_lit_slot({room_with_slot(), {.tolerance = 0.01}}, 0.1); }

TEST(UnseenParts, FloorOfASlotIsSeenWhereTheToleranceIsByPlace) {
  expect_lit_slot({room_with_slot(), {.tolerance = 0.2, .area_share = 0.999}}, 0.25);
}

// The sides of boards that stand 2 mm apart are dark, but for strips about as wide as the gaps along their openings.
TEST(UnseenParts, OpeningsOfNarrowGapsAreLit) {
  Scene scene = lit_room();
  constexpr double step = 0.03, gap = 0.002;
  for (int n = 0; n < 24; ++n) add_box(scene, {0.14 + step * n, 0, 0.2}, {0.14 + step * (n + 1) - gap, 0.3, 0.8}, false);
  const Comparison boards(scene, {.tolerance = 0.05});
  for (const int n : {6, 12, 18})
    for (const double z : {0.3, 0.5, 0.7}) {
      const double right = 0.14 + step * n, left = right - gap;
      EXPECT_NEAR(boards.ratio_at({left, 0.299, z}, {1, 0, 0}), 1, 0.35) << n << " " << z;
      EXPECT_NEAR(boards.ratio_at({right, 0.299, z}, {-1, 0, 0}), 1, 0.35) << n << " " << z;
    }
}

}  // namespace
}  // namespace alvor
