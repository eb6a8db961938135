#include "radiosity/exchange/strategies.h"

#include "radiosity/solve/pass.h"
#include "tests/radiosity/systems.h"
#include "tests/scenes.h"

#include <cmath>

namespace alvor {
namespace {

using test::System;

constexpr Strategy all[]{Strategy::gather, Strategy::shoot, Strategy::sorted, Strategy::sorted_ambient, Strategy::overshoot};
constexpr Strategy shooters[]{Strategy::shoot, Strategy::sorted, Strategy::sorted_ambient, Strategy::overshoot};

void step_until(Strategy strategy, Shooting& shooting, double unshot_power) {
  const auto stepper = make_stepper(strategy, shooting);
  for (int round = 0; round < 2000 && shooting.unshot_power() > unshot_power; ++round) {
    for (std::size_t n = 0; n < shooting.patch_count(); ++n) stepper->step();
    if (strategy == Strategy::gather) shooting.find_unshot();
  }
  EXPECT_LE(shooting.unshot_power(), unshot_power);
}

void expect_close(std::span<const RelativeLight> got, std::span<const RelativeLight> expected, double absolute_error) {
  ASSERT_EQ(got.size(), expected.size());
  for (std::size_t n = 0; n < got.size(); ++n) EXPECT_LE(absolute(got[n] - expected[n]).max(), absolute_error) << n;
}

TEST(Strategies, StepsOfAllEndAtTheSameSolution) {
  for (unsigned seed = 0; seed < 5; ++seed) {
    const System system(seed);
    const auto solved = system.solved();
    for (const Strategy strategy : all) {
      SCOPED_TRACE(text(strategy));
      Shooting shooting = system.begun();
      step_until(strategy, shooting, 1e-10 * shooting.unshot_power());
      test::expect_near(shooting.shot(), solved, 1e-6);
    }
  }
}

TEST(Strategies, OfAllEndAtTheSameSolutionWithTranslucentFaces) {
  for (unsigned seed = 0; seed < 3; ++seed) {
    const System opaque(seed), system = opaque.with_translucent_faces(seed);
    const auto solved = system.solved();
    for (const Strategy strategy : all) {
      SCOPED_TRACE(text(strategy));
      Shooting stepped = system.begun();
      step_until(strategy, stepped, 1e-10 * stepped.unshot_power());
      test::expect_near(stepped.shot(), solved, 1e-6);
      Shooting swept = system.begun();
      const auto stepper = make_stepper(strategy, swept);
      const double enough = 1e-10 * swept.unshot_power();
      for (int n = 0; n < 10'000 && swept.unshot_power() > enough; ++n) stepper->sweep();
      test::expect_near(swept.shot(), solved, 1e-6);
    }
  }
}

// Also halfway: e + R F x - x of what is shot, with what is shot of the irradiance.
TEST(Strategies, KnowTheUnshotLightOfTranslucentFaces) {
  const System opaque(4), system = opaque.with_translucent_faces(4);
  Shooting shooting = system.begun();
  shooting.keep_ambient_account();
  const auto stepper = make_stepper(Strategy::sorted, shooting);
  for (int n = 0; n < 30; ++n) stepper->step();
  const auto left = system.residual(shooting.shot()), unshot = shooting.unshot_by_leaf();
  RelativeLight power;
  for (std::uint32_t leaf = 0; leaf < left.size(); ++leaf) {
    EXPECT_LT(absolute(left[leaf] - unshot[leaf]).max(), 1e-12) << leaf;
    power += shooting.leaf_area(leaf) * left[leaf];
  }
  const RelativeLight known = shooting.ambient_irradiance(), fresh = ambient_gain(system.patches) * power;
  EXPECT_LT(absolute(known - fresh).max(), 1e-9 * fresh.max());
}

TEST(Strategies, SweepsOfAllEndAtTheSameSolution) {
  const System system(8, 50);
  for (const Strategy strategy : all) {
    SCOPED_TRACE(text(strategy));
    Shooting shooting = system.begun();
    const auto stepper = make_stepper(strategy, shooting);
    const double enough = 1e-10 * shooting.unshot_power();
    for (int n = 0; n < 10'000 && shooting.unshot_power() > enough; ++n) stepper->sweep();
    test::expect_near(shooting.shot(), system.solved(), 1e-6);
  }
}

TEST(Strategies, AgreeOnARoom) {
  const BaseMesh mesh(test::coloured_room());
  RayBudget budget([] { return false; });
  SolveState state(mesh, {.max_depth = 4}, budget);
  Pass pass(state);
  pass.prepare();
  std::vector<RelativeLight> expected;
  for (const Strategy strategy : all) {
    SCOPED_TRACE(text(strategy));
    Shooting shooting = pass.unshot_system();
    step_until(strategy, shooting, 1e-9 * shooting.unshot_power());
    const auto shot = shooting.shot();
    if (expected.empty()) expected = shot;
    double largest = 0;
    for (const RelativeLight& x : expected) largest = std::max(largest, x.max());
    EXPECT_GT(state.in_watts_per_m2({largest, largest, largest}).max(), 0.1);
    expect_close(shot, expected, 1e-6 * largest);
  }
}

TEST(Strategies, UnshotIsTheResidualAfterAnyNumberOfSteps) {
  const System system(3, 30);
  for (const Strategy strategy : all) {
    SCOPED_TRACE(text(strategy));
    Shooting shooting = system.begun();
    const auto stepper = make_stepper(strategy, shooting);
    for (const int steps : {1, 1, 1, 7, 50, 500}) {
      for (int n = 0; n < steps; ++n) stepper->step();
      if (strategy == Strategy::gather) shooting.find_unshot();
      expect_close(shooting.unshot_by_leaf(), system.residual(shooting.shot()), 1e-9);
    }
  }
}

TEST(Strategies, AmbientAccountEqualsWhatIsUnshotAfterAnyNumberOfShots) {
  const System system(4, 30);
  double area = 0;
  Rgb reflected;
  for (const ShootingPatch& patch : system.patches) {
    area += patch.area;
    reflected += patch.area * patch.reflectance;
  }
  for (const Strategy strategy : shooters) {
    SCOPED_TRACE(text(strategy));
    Shooting shooting = system.begun();
    shooting.keep_ambient_account();
    const auto stepper = make_stepper(strategy, shooting);
    for (int n = 0; n < 300; ++n) {
      const auto left = system.residual(shooting.shot());
      RelativeLight unshot;
      for (std::size_t leaf = 0; leaf < left.size(); ++leaf) unshot += system.leaves[leaf].area * left[leaf];
      const RelativeLight expected{unshot.r / (area - reflected.r), unshot.g / (area - reflected.g),
                                   unshot.b / (area - reflected.b)};
      ASSERT_LE(absolute(shooting.ambient_irradiance() - expected).max(), 1e-9) << "after " << n << " shots";
      stepper->step();
    }
  }
}

TEST(Strategies, AmbientTermBalancesTheEnergyOfAUniformEnclosureAfterEveryShot) {
  // With uniform rho and reciprocal rows, sum A (B + rho ambient) = sum A E / (1 - rho), where B is shot plus unshot radiosity.
  constexpr double rho = 0.8;
  const System system = System::reciprocal(1, 40, rho, 3);
  RelativeLight emitted;
  for (const ShootingLeaf& leaf : system.leaves) emitted += leaf.area * leaf.unshot;
  for (const Strategy strategy : shooters) {
    SCOPED_TRACE(text(strategy));
    Shooting shooting = system.begun();
    const auto stepper = make_stepper(strategy, shooting);
    for (int n = 0; n < 200; ++n) {
      const auto irradiance = shooting.irradiance();
      const RelativeLight ambient = shooting.ambient_irradiance();
      RelativeLight sum;
      for (std::size_t p = 0; p < irradiance.size(); ++p)
        sum += system.leaves[p].area * (system.leaves[p].unshot + rho * (irradiance[p] + ambient));
      const RelativeLight expected = 1 / (1 - rho) * emitted;
      ASSERT_LE(absolute(sum - expected).max(), 1e-10 * expected.max()) << "after " << n << " shots";
      stepper->step();
    }
  }
}

TEST(Strategies, GatheringDividesTheWholeSumWhereAPatchSeesItself) {
  // A single patch of two leaves sees nothing but itself, so one step must give x = e / (1 - rho).
  std::vector<TransportRow> rows(1);
  rows[0].hits.resize(64);
  rows[0].rays = 64;
  const std::vector<ShootingPatch> patches{{&rows[0], 0, 2, {0.5, 0.9, 0}, 2}};
  std::vector<std::uint32_t> hit_leaf(64);
  for (std::size_t h = 0; h < 32; ++h) hit_leaf[h] = 1;
  Shooting shooting(patches, {{1, {1, 1, 1}, {}}, {1, {3, 3, 3}, {}}}, hit_leaf);
  shooting.find_unshot();
  const auto stepper = make_stepper(Strategy::gather, shooting);
  stepper->step();
  const std::vector<RelativeLight> expected{{1 + 0.5 * 2 / 0.5, 1 + 0.9 * 2 / 0.1, 1}, {3 + 0.5 * 2 / 0.5, 3 + 0.9 * 2 / 0.1, 3}};
  expect_close(shooting.shot(), expected, 1e-12);
  shooting.find_unshot();
  EXPECT_LT(shooting.unshot_power(), 1e-12);
}

TEST(Strategies, ShootersThatSeeThemselvesKeepWhatComesBack) {
  const System system = System::reciprocal(5, 4, 0.5, 1);
  Shooting shooting = system.begun();
  shooting.shoot(0);
  double own = 0;
  for (std::size_t h = 0; h < system.rows[0].hits.size(); ++h) own += system.hit_leaf[h] == 0;
  ASSERT_GT(own, 0);
  EXPECT_NEAR(shooting.unshot_by_leaf()[0].r, 0.5 * own / double(system.rows[0].hits.size()), 1e-12);
}

TEST(Strategies, SortedShootsTheLargestUnshotPowerFirst) {
  const System system(6, 100);
  Shooting shooting = system.begun();
  const auto stepper = make_stepper(Strategy::sorted, shooting);
  for (int n = 0; n < 200; ++n) {
    double largest = 0;
    std::uint32_t largest_at = 0;
    for (std::uint32_t p = 0; p < 100; ++p)
      if (const double power = shooting.unshot_power_of(p); power > largest) largest = power, largest_at = p;
    stepper->step();
    EXPECT_LT(shooting.unshot_power_of(largest_at), largest) << "after " << n << " shots";
  }
}

/// Returns the number of steps until the RMS error of the displayed irradiance is at most `error` times the solution's RMS.
int steps_to(double error, Strategy strategy, const System& system, std::span<const RelativeLight> solved) {
  Shooting shooting = system.begun();
  const auto stepper = make_stepper(strategy, shooting);
  const auto solved_irradiance = system.gathered(solved);
  for (int steps = 0;; ++steps) {
    const auto irradiance = shooting.irradiance();
    const RelativeLight ambient = shows_ambient(strategy) ? shooting.ambient_irradiance() : RelativeLight{};
    double squares = 0, reference = 0;
    for (std::size_t p = 0; p < irradiance.size(); ++p) {
      const double difference = (irradiance[p] + ambient - solved_irradiance[p]).r;
      squares += system.patches[p].area * difference * difference;
      reference += system.patches[p].area * solved_irradiance[p].r * solved_irradiance[p].r;
    }
    if (squares <= error * error * reference || steps == 100'000) return steps;
    stepper->step();
  }
}

TEST(Strategies, ConvergeInTheOrderOfTheLiterature) {
  // One of 200 patches emits and rho is 0.8, as in published comparisons with exact form factors. There gathering is slowest,
  // overshooting is far ahead, and the ambient term is ahead of all at first.
  const System system = System::reciprocal(2, 200, 0.8, 1);
  const auto solved = system.solved();
  const auto steps = [&](double error, Strategy strategy) { return steps_to(error, strategy, system, solved); };
  EXPECT_LT(steps(0.1, Strategy::sorted), steps(0.1, Strategy::shoot));
  EXPECT_LT(steps(0.1, Strategy::sorted), steps(0.1, Strategy::gather));
  EXPECT_LT(steps(0.1, Strategy::sorted_ambient), steps(0.1, Strategy::overshoot));
  EXPECT_LT(2 * steps(1e-6, Strategy::overshoot), steps(1e-6, Strategy::sorted));
  EXPECT_LE(steps(1e-6, Strategy::sorted), steps(1e-6, Strategy::gather));
}

TEST(Strategies, OvershootingArrivesWhereTheAmbientTermIsWrong) {
  // Two rooms do not see each other, so all light that is advanced in the dark one must be taken back.
  System both = System::reciprocal(3, 20, 0.9, 1);
  const System dark = System::reciprocal(4, 20, 0.9, 0);
  for (ShootingPatch patch : dark.patches) {
    patch.first_leaf += 20;
    both.patches.push_back(patch);
  }
  both.rows.insert(both.rows.end(), dark.rows.begin(), dark.rows.end());
  for (std::size_t p = 0; p < 40; ++p) both.patches[p].row = &both.rows[p];
  both.leaves.insert(both.leaves.end(), dark.leaves.begin(), dark.leaves.end());
  for (const std::uint32_t leaf : dark.hit_leaf) both.hit_leaf.push_back(leaf + 20);
  Shooting shooting = both.begun();
  step_until(Strategy::overshoot, shooting, 1e-10 * shooting.unshot_power());
  expect_close(shooting.shot(), both.solved(), 1e-6);
}

TEST(Strategies, OvershootingArrivesWhereItWouldGrowWithoutBounds) {
  // Patches are nearly white and look mostly at a quarter of them, so the light that these few shoot comes back many times.
  for (unsigned seed = 0; seed < 5; ++seed) {
    System system(seed, 40);
    std::mt19937 random(seed);
    for (ShootingPatch& patch : system.patches) patch.reflectance = {0.995, 0.995, 0.995};
    for (std::uint32_t& leaf : system.hit_leaf)
      if (random() % 4 != 0) leaf %= 1 + std::uint32_t(system.leaves.size() / 4);
    Shooting shooting = system.begun();
    const double start = shooting.unshot_power();
    const auto stepper = make_stepper(Strategy::overshoot, shooting);
    double highest = 0;
    for (int n = 0; n < 500'000 && shooting.unshot_power() > 1e-9 * start; ++n) {
      stepper->step();
      highest = std::max(highest, shooting.unshot_power());
    }
    EXPECT_LT(highest, 1000 * start);
    EXPECT_LE(shooting.unshot_power(), 1e-9 * start);
    expect_close(shooting.unshot_by_leaf(), system.residual(shooting.shot()), 1e-7);
  }
}

}  // namespace
}  // namespace alvor
