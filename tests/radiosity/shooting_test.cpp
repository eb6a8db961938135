#include "tests/radiosity/systems.h"

namespace alvor {
namespace {

using test::expect_near;
using test::System;

void shoot_all(Shooting& shooting) {
  const double start = shooting.unshot_power();
  const auto stepper = make_stepper(Strategy::sorted, shooting);
  while (shooting.unshot_power() > 1e-12 * start) stepper->sweep();
}

TEST(Shooting, ConvergesToTheSolutionOfTheRows) {
  for (unsigned seed = 0; seed < 5; ++seed) {
    const System system(seed);
    Shooting shooting(system.patches, system.leaves, system.hit_leaf);
    shooting.find_unshot();
    shoot_all(shooting);
    expect_near(shooting.shot(), system.solved(), 1e-9);
  }
}

TEST(Shooting, GoesOnFromAnyStateBecauseUnshotIsTheResidual) {
  const System system(7);
  System started = system;
  std::mt19937 random(1);
  for (ShootingLeaf& leaf : started.leaves) {  // more was "shot" in some places than is right: negative residuals follow
    leaf.shot = double(random() % 10) * RelativeLight{1, 0, 1};
    leaf.unshot -= leaf.shot;
  }
  Shooting shooting(started.patches, started.leaves, started.hit_leaf);
  shooting.find_unshot();
  shoot_all(shooting);
  expect_near(shooting.shot(), system.solved(), 1e-9);
}

TEST(Shooting, IrradianceIsTheRowsTimesWhatWasShot) {
  const System system(3);
  Shooting shooting(system.patches, system.leaves, system.hit_leaf);
  shooting.find_unshot();
  const auto stepper = make_stepper(Strategy::sorted, shooting);
  for (int n = 0; n < 5; ++n) stepper->sweep();
  const auto shot = shooting.shot();
  for (std::size_t p = 0; p < system.patches.size(); ++p) {
    RelativeLight sum;
    for (std::size_t h = 0; h < 64; ++h) sum += shot[system.hit_leaf[64 * p + h]];
    EXPECT_NEAR(shooting.irradiance()[p].r, sum.r / 64, 1e-12);
  }
}

}  // namespace
}  // namespace alvor
