// Tests of largest_errors(): the objects that hold most of the error that a solution tells.

#include "client/verify/object_errors.h"
#include "radiosity/solve/solver.h"
#include "tests/scenes.h"

#include <gtest/gtest.h>

namespace alvor {
namespace {

TEST(ObjectErrors, AreSharesOfAreaAndOfSquaredError) {
  Scene scene = test::coloured_room();
  scene.objects = {{"holder", {}, {}, 0, 0}, {"room", {}, {}, 0, 6}, {"block", {}, {}, 6, 6}};  // the lamp is of no object
  const BaseMesh mesh(scene);
  SolutionLog log;
  solve(mesh, {.tolerance = 0.9, .max_depth = 0}, log, {});
  const auto& leaves = log.leaves();
  // Errors of 1 W/m2 on the room, of 3 on the block, of 20 on the lamp: 94 x 1, 10 x 9 and 1 x 400 W2.
  std::vector<float> errors;
  for (const LeafValue& leaf : leaves) {
    const std::uint32_t face = mesh.roots()[leaf.patch.root_face()].input.first;
    errors.push_back(face < 6 ? 1.0F : face < 12 ? 3.0F : 20.0F);
  }
  const double area = 94 + 10 + 1, squares = 94 + 9 * 10 + 400;
  const auto one = largest_errors(mesh, leaves, errors, 5);
  ASSERT_EQ(one.size(), 1u) << "the lamp alone has more than half";
  EXPECT_EQ(one[0].name, "");
  EXPECT_NEAR(one[0].area_share, 1 / area, 1e-6);
  EXPECT_NEAR(one[0].error_share, 400 / squares, 1e-6);
  errors.assign(leaves.size(), 1.0F);
  EXPECT_EQ(largest_errors(mesh, leaves, errors, 5).at(0).name, "room");
  EXPECT_TRUE(largest_errors(mesh, leaves, {}, 5).empty());
}

}  // namespace
}  // namespace alvor
