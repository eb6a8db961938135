// Invariants of every solution, checked on two scenes made by hand. tests/random looks for scenes that break them.

#include "radiosity/solve/pass.h"
#include "radiosity/solve/solver.h"
#include "tests/scene_changes.h"
#include "tests/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

namespace alvor {
namespace {

constexpr SolveOptions options{.tolerance = 0.02, .max_leaves = 4000, .threads = 1};

/// Returns an open scene: a two-sided plate that emits, above a block and a ground, in an absorbing medium.
Scene pavilion() {
  Scene scene;
  scene.materials = {test::grey(0, 0.5), {"plate", {3, 2, 1}, {0.2, 0.4, 0.6}, true}};
  scene.absorption = {0.02, 0.05, 0};
  test::add_polygon(scene, {{0, 0, 0}, {0, 0, 6}, {6, 0, 6}, {6, 0, 0}});
  test::add_box(scene, {1, 0.4, 1}, {2, 1, 3}, false);
  test::add_polygon(scene, {{2, 2, 2}, {4, 2.5, 2}, {4, 2.5, 4}, {2, 2, 4}}, 1);
  return scene;
}

struct Solution {
  std::vector<LeafValue> leaves;
  Step last;
  PowerBalance balance;
};

Solution solution_of(const BaseMesh& mesh, const SolveOptions& how = options) {
  SolutionLog log;
  const auto outcome = solve(mesh, how, log, {});
  return {log.leaves(), log.last_step(), outcome.balance};
}
Solution solution_of(const Scene& scene, const SolveOptions& how = options) { return solution_of(BaseMesh(scene), how); }

double mean_irradiance(const Scene& scene) {
  const BaseMesh mesh(scene);
  double power = 0, area = 0;
  for (const LeafValue& leaf : solution_of(mesh).leaves) {
    const double here = area_of(mesh, shape_of(mesh, leaf.patch));
    power += here * widen(leaf.irradiance).mean();
    area += here;
  }
  return power / area;
}

/// Returns the sum of the row's weights over its rays, in the band that fades least.
double row_sum(const ShootingPatch& patch) {
  return patch.row->is_hidden() ? 0 : patch.row->stored_weight().max() / patch.row->ray_count();
}

class Invariant : public testing::TestWithParam<Scene (*)()> {
 protected:
  Scene scene() const { return GetParam()(); }
};
INSTANTIATE_TEST_SUITE_P(Scenes, Invariant, testing::Values(&test::coloured_room, &pavilion),
                         [](const auto& scene) { return scene.index == 0 ? "ARoom" : "APavilion"; });

TEST_P(Invariant, IrradianceIsFiniteAndNotNegative) {
  for (const LeafValue& leaf : solution_of(scene()).leaves) {
    EXPECT_TRUE(leaf.irradiance.is_finite());
    EXPECT_GE(leaf.irradiance.min(), 0);
  }
}

TEST_P(Invariant, NothingIsBrighterThanIfAllWereLikeTheBrightest) {
  const BaseMesh mesh(scene());
  Rgb emission, reflectance;
  for (const Material& material : mesh.materials()) {
    emission = upper(emission, material.emission);
    reflectance = upper(reflectance, material.reflectance);
  }
  constexpr double rounding = 1e-6;  // irradiance is published as float32, which rounds by 6e-8; the rest is margin
  for (const LeafValue& leaf : solution_of(mesh).leaves) {
    const Material& material = mesh.material_of(leaf.patch.root_face());
    const Rgb radiosity = material.emission + material.reflectance * widen(leaf.irradiance);
    EXPECT_LE(radiosity.r, (1 + rounding) * emission.r / (1 - reflectance.r));
    EXPECT_LE(radiosity.g, (1 + rounding) * emission.g / (1 - reflectance.g));
    EXPECT_LE(radiosity.b, (1 + rounding) * emission.b / (1 - reflectance.b));
  }
}

TEST_P(Invariant, RowSumsAreAtMostOne) {
  for (const auto method : {FormFactorMethod::nusselt, FormFactorMethod::hemicube, FormFactorMethod::analytic}) {
    const BaseMesh mesh(scene());
    RayBudget budget([] { return false; });
    SolveState state(mesh, {.max_leaves = 60, .form_factors = method}, budget);
    Pass pass(state);
    pass.prepare();
    for (const Shooting system = pass.unshot_system(); const ShootingPatch& patch : system.patches())
      EXPECT_LE(row_sum(patch), 1 + 1e-6);
  }
}

// Shadow rays are sampled: the power of one of these solves is off by about 2.4e-4 (one standard deviation) of what is emitted, the
// mean of eight by 8.5e-5. The bounds are four and three and a half of these.
TEST_P(Invariant, PowerIsNeitherMadeNorLost) {
  SolveOptions fine = options;
  fine.tolerance = 0.005;
  fine.max_leaves = 50'000;
  double emitted = 0;
  for (const BaseMesh mesh(scene()); const RootPatch& root : mesh.roots())
    emitted += root.area * mesh.materials()[root.material].emission.sum();
  constexpr int solves = 8;
  double found = 0;
  for (fine.seed = 1; fine.seed <= solves; ++fine.seed) {
    const PowerBalance balance = solution_of(scene(), fine).balance;
    EXPECT_NEAR(balance.emitted, emitted, 1e-12 * emitted);
    EXPECT_NEAR(balance.absorbed + balance.lost + balance.unshot, emitted, 1e-3 * emitted);
    found += (balance.absorbed + balance.lost + balance.unshot) / solves;
  }
  EXPECT_NEAR(found, emitted, 3e-4 * emitted);
}

TEST_P(Invariant, EmissionTimesAPowerOfTwoGivesThatMultipleToTheByte) {
  const Solution plain = solution_of(scene());
  for (const float factor : {0x1p-80f, 0.5f, 0x1p80f}) {
    const Solution scaled = solution_of(test::with_emission_times(scene(), factor));
    EXPECT_EQ(scaled.last.estimated_error, plain.last.estimated_error);
    ASSERT_EQ(scaled.leaves.size(), plain.leaves.size());
    for (std::size_t n = 0; n < plain.leaves.size(); ++n)
      ASSERT_EQ(scaled.leaves[n].irradiance, factor * plain.leaves[n].irradiance);
  }
}

TEST_P(Invariant, LengthsTimesAPowerOfTwoGiveTheSameBytes) {
  const Solution plain = solution_of(scene());
  for (const double factor : {0x1p-20, 0x1p20})
    EXPECT_EQ(solution_of(test::with_lengths_times(scene(), factor)).leaves, plain.leaves);
}

TEST_P(Invariant, SwappedBandsGiveTheSameBytesSwapped) {
  Solution plain = solution_of(scene());
  for (LeafValue& leaf : plain.leaves) leaf.irradiance = test::red_and_green_swapped(leaf.irradiance);
  EXPECT_EQ(solution_of(test::with_red_and_green_swapped(scene())).leaves, plain.leaves);
}

TEST_P(Invariant, SameSeedGivesTheSameBytesOnAnyNumberOfThreads) {
  SolveOptions two = options;
  two.threads = 2;
  EXPECT_EQ(solution_of(scene()).leaves, solution_of(scene(), two).leaves);
}

TEST_P(Invariant, OrderOfFacesDoesNotMatterBeyondTheTolerance) {
  std::vector<std::uint32_t> order(scene().faces.size());
  std::iota(order.begin(), order.end(), 0u);
  std::ranges::reverse(order);
  const double plain = mean_irradiance(scene());
  EXPECT_NEAR(mean_irradiance(test::with_faces_in_order(scene(), order)), plain, options.tolerance * plain);
}

TEST_P(Invariant, CuttingAFaceDoesNotMatterBeyondTheTolerance) {
  const double plain = mean_irradiance(scene());
  for (const std::uint32_t face : {0u, 3u})
    EXPECT_NEAR(mean_irradiance(test::with_face_cut(scene(), face)), plain, options.tolerance * plain);
}

TEST(Invariants, TwoSidesAreTwoFacesBackToBack) {
  EXPECT_EQ(solution_of(pavilion()).leaves, solution_of(test::with_backs_as_faces(pavilion())).leaves);
}

TEST(Invariants, WhereNothingReflectsWhatDoesNotArriveIsLost) {
  const PowerBalance balance = solution_of(test::black(pavilion())).balance;
  EXPECT_GT(balance.absorbed, 0.1 * balance.emitted);
  EXPECT_GT(balance.lost, 0.1 * balance.emitted);
  EXPECT_NEAR(balance.gap(), 0, 1e-12);
}

TEST(Invariants, EverythingPublishedIsFiniteWhateverTheEmission) {
  for (const double emission : {1e-300, 1e-30, 1e30}) {
    const Solution solution = solution_of(test::with_emission_times(test::coloured_room(), emission / 50));
    EXPECT_TRUE(std::isfinite(solution.last.estimated_error));
    EXPECT_LE(solution.last.estimated_error, options.tolerance);
    for (const LeafValue& leaf : solution.leaves) EXPECT_TRUE(leaf.irradiance.is_finite());
  }
}

// All but the rim of the floor lies under a block, so that only few of a patch's sixteen origins are visible.
TEST(Invariants, ExactRowsUnderABlockAreNoMoreThanAHemisphere) {
  Scene scene = test::furnace(1, 0.5);
  test::add_box(scene, {0.1, 0, 0.1}, {3, 1, 4}, false);
  const BaseMesh mesh(scene);
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    RayBudget budget([] { return false; });
    SolveState state(mesh, {.max_leaves = 12, .seed = seed, .form_factors = FormFactorMethod::analytic}, budget);
    Pass pass(state);
    pass.prepare();
    for (const Shooting system = pass.unshot_system(); const ShootingPatch& patch : system.patches())
      EXPECT_LE(row_sum(patch), 1 + 1e-6) << "seed " << seed;
  }
}

// Exact rows are computed again in each pass, for finer leaves.
TEST(Invariants, ExactRowsFromWhichNoRayEscapedSumToOneInEveryPass) {
  const BaseMesh mesh(test::coloured_room());
  RayBudget budget([] { return false; });
  SolveState state(mesh, {.max_leaves = 1000, .form_factors = FormFactorMethod::analytic}, budget);
  int passes = 0;
  for (bool goes_on = true; goes_on && passes < 3; ++passes) {
    Pass pass(state);
    pass.prepare();
    for (const Shooting system = pass.unshot_system(); const ShootingPatch& patch : system.patches())
      EXPECT_TRUE(!patch.row->is_closed || std::abs(row_sum(patch) - 1) < 1e-6) << row_sum(patch) << " in pass " << passes;
    settle(pass.exchange(), 1e-3, [](std::size_t) { return true; });
    pass.estimate();
    goes_on = pass.refine();
  }
  EXPECT_GE(passes, 2);
}

}  // namespace
}  // namespace alvor
