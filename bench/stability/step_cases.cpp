#include "bench/error_vs_time/contest/figures.h"
#include "bench/stability/case.h"
#include "bench/stability/enclosures.h"
#include "bench/stability/row_system.h"

namespace alvor::bench {

namespace {

constexpr double fine = 1e-6;

/// Counts the steps, of one row or column each, per patch down to an error of 1e-6: they must be fewer than those of the best
/// strategy on record.
Case steps(const std::string& name, double reflectance, double limit, const std::string& record, Scene scene) {
  return {name, "rho " + figure(reflectance, 9), "fewer steps a patch than " + record, limit, [=] {
            RowSystem system(scene, 3);
            const double taken = system.steps_down_to(fine);
            return system.measured(figure(taken, 3) + " n, n = " + std::to_string(system.size()), taken);
          }};
}

Scene corridor(double reflectance) {
  Scene scene;
  scene.materials = {grey(0, reflectance), grey(1, reflectance)};
  add_room(scene, {0, 0, 0}, {1, 1, 10}, {0, 0, 0, 0, 1, 0});
  return scene;
}

}  // namespace

std::vector<Case> step_cases() {
  std::vector<Case> cases;
  const auto cube = [](double reflectance) { return unit_cube(grey(1, reflectance), grey(0, reflectance)); };
  cases.push_back(
      steps("cube 8 x 8, one face emits", 0.95, 6.7, "overshooting, 6.7 (sorted 135, conjugate gradients 10)", cube(0.95)));
  cases.push_back(steps("corridor 1 x 1 x 10, the end emits", 0.95, 19, "conjugate gradients, 19 (sorted 125, overshooting 62)",
                        corridor(0.95)));
  for (const double reflectance : {0.999, 0.999999}) {
    cases.push_back(
        steps("cube 8 x 8, one face emits", reflectance, 10, "conjugate gradients at rho 0.95, 10", cube(reflectance)));
    cases.push_back(steps("corridor 1 x 1 x 10, the end emits", reflectance, 19, "conjugate gradients at rho 0.95, 19",
                          corridor(reflectance)));
  }
  return cases;
}

}  // namespace alvor::bench
