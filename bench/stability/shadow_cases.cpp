// A lit room with blockers that a shadow cast exactly may stumble over, compared with path tracing.

#include "bench/error_vs_time/contest/figures.h"
#include "bench/stability/case.h"
#include "bench/stability/enclosures.h"
#include "bench/stability/solved_scene.h"
#include "client/verify/verification.h"
#include "meshing/display_mesh.h"

#include <array>
#include <cmath>

namespace alvor::bench {

namespace {

// The tolerance makes the solve cast exact shadows; an estimate may be off by as much again.
constexpr double tolerance = 0.015, limit = 2 * tolerance;
constexpr double lamp_height = 2.5;

/// Returns a grey room of 4 x 3 x 5 m with a lamp of 1 m2 half a metre below its ceiling, and with what `add` adds.
template <class Add>
Scene lit_room_with(Add add) {
  constexpr double y = lamp_height;
  Scene scene;
  scene.materials = {grey(0, 0.6), grey(50, 0)};
  add_room(scene, {0, 0, 0}, {4, 3, 5});
  add_quad(scene, {1.5, y, 2}, {2.5, y, 2}, {2.5, y, 3}, {1.5, y, 3}, 1);
  add(scene);
  return scene;
}

/// Adds a level square of 1 m2 about a point, seen from below and above.
void add_plate(Scene& scene, double x, double y, double z) {
  add_quad(scene, {x, y, z}, {x, y, z + 1}, {x + 1, y, z + 1}, {x + 1, y, z});
  add_quad(scene, {x, y, z}, {x + 1, y, z}, {x + 1, y, z + 1}, {x, y, z + 1});
}

Scene block_at_the_lamp() {
  return lit_room_with([](Scene& scene) { add_block(scene, {1.2, 1.5, 2.2}, {2.1, lamp_height, 2.7}); });
}
Scene block_through_the_lamp() {
  return lit_room_with([](Scene& scene) { add_block(scene, {1.7, 1.9, 2.2}, {2.1, 2.8, 2.5}); });
}
Scene block_on_the_floor() {
  return lit_room_with([](Scene& scene) { add_block(scene, {1, 0, 1}, {2, 1, 3}); });
}
Scene plate_in_the_plane_of_the_lamp() {
  return lit_room_with([](Scene& scene) { add_plate(scene, 2.5, lamp_height, 2); });
}
Scene plate_on_the_floor() {
  return lit_room_with([](Scene& scene) { add_plate(scene, 1.3, 0, 1.7); });
}
Scene sliver_blockers() {
  return lit_room_with([](Scene& scene) {
    for (int n = 0; n < 8; ++n) {
      const double x = 1.2 + 0.2 * n;
      add_block(scene, {x, 1.2, 1}, {x + 1e-5, 1.4, 4});
    }
  });
}
Scene blocker_twice() {
  return lit_room_with([](Scene& scene) {
    for (int n = 0; n < 2; ++n) add_block(scene, {1.2, 1, 1.8}, {2.2, 1.3, 2.6});
  });
}
Scene crossing_blockers() {
  return lit_room_with([](Scene& scene) {
    add_block(scene, {1, 1, 2}, {3, 1.3, 2.5});
    add_block(scene, {1.7, 0.8, 1}, {2.2, 1.6, 4});
    add_block(scene, {1.5, 1.1, 1.8}, {2.5, 1.2, 2.8});
  });
}
/// A second lamp inside a block brings no light; what the block hides of it must not leak.
Scene lamp_in_a_solid() {
  return lit_room_with([](Scene& scene) {
    add_block(scene, {0.5, 0.5, 0.5}, {1.5, 1.2, 1.5});
    add_quad(scene, {0.8, 0.9, 0.8}, {1.2, 0.9, 0.8}, {1.2, 0.9, 1.2}, {0.8, 0.9, 1.2}, 1);
  });
}
Scene two_blocks() {
  return lit_room_with([](Scene& scene) {
    add_block(scene, {1, 0, 1}, {2, 1, 3});
    add_block(scene, {2.2, 1.2, 2.2}, {2.8, 1.4, 3});
  });
}

Case lit(const std::string& name, const std::string& condition, Scene (*scene)()) {
  return {name, condition, "irradiance at 400 points by path tracing; nRMSE", limit, [=] {
            const Scene room = scene();
            const SolvedScene solved(room, {.tolerance = tolerance});
            if (solved.fault()) return Measured{solved.fault()->text(), INFINITY};
            const DisplayMesh mesh = build_display_mesh(solved.mesh(), solved.leaves());
            VerifyOptions options{.points = 400, .trace = {}};
            options.trace.threads = 1;
            const Verification compared = verify(room, mesh, options);
            return solved.measured(figure(100 * compared.errors.nrmse.value, 2) + " %, with a truth of " +
                                       figure(100 * compared.errors.truth_error, 2) + " %; " +
                                       std::to_string(compared.hidden_lit) + " points lit in solids",
                                   compared.errors.nrmse.value);
          }};
}

}  // namespace

std::vector<Case> shadow_cases() {
  std::vector<Case> cases{lit("a block at the lamp", "its upper side in the lamp's plane", block_at_the_lamp),
                          lit("a block on the floor", "touching what it darkens", block_on_the_floor),
                          lit("a plate beside the lamp", "in its plane, with a common edge", plate_in_the_plane_of_the_lamp),
                          lit("eight slats", "0.01 mm thick", sliver_blockers),
                          lit("a block", "there twice", blocker_twice),
                          lit("three blocks", "crossing each other", crossing_blockers),
                          lit("a second lamp", "inside a block", lamp_in_a_solid),
                          lit("two blocks", "the metre is 1e-6", [] { return placed(two_blocks(), 1e-6); }),
                          lit("two blocks", "the metre is 1e6", [] { return placed(two_blocks(), 1e6); })};
  Case through = lit("a block through the lamp", "crossing", block_through_the_lamp);
  through.remark = "the light on the block jumps where the lamp's plane crosses it, which leaves can only follow by their size.";
  Case plate = lit("a plate on the floor", "in its plane", plate_on_the_floor);
  plate.remark =
      "the plate and the floor below it both take up the lamp's light: 2 % more power than there is, which the estimate tells.";
  for (Case* slow : {&through, &plate}) {
    slow->is_quick = false;  // they end at their limit of time
    cases.push_back(*slow);
  }
  return cases;
}

}  // namespace alvor::bench
