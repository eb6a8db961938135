// A solve that is given more time has a smaller error.

#include "client/verify/error_statistics.h"
#include "client/verify/irradiance_estimate.h"
#include "client/verify/probe.h"
#include "client/verify/surface_points.h"
#include "meshing/display_mesh.h"
#include "radiosity/solve/solver.h"
#include "tests/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace alvor {
namespace {

using test::add_box;
using test::add_polygon;
using test::grey;

/// Returns a closed room of 4 x 3 x 5 m without a lamp; material 1 emits.
Scene empty_room(double reflectance = 0.6) {
  Scene scene;
  scene.materials = {grey(0, reflectance), grey(50, 0)};
  add_box(scene, {0, 0, 0}, {4, 3, 5}, true);
  return scene;
}

void add_lamp(Scene& scene, double side = 1) {
  const double x = 2 - side / 2, X = 2 + side / 2, z = 2.5 - side / 2, Z = 2.5 + side / 2, y = 2.9;
  add_polygon(scene, {{x, y, z}, {X, y, z}, {X, y, Z}, {x, y, Z}}, 1);
}

template <class Add>
Scene room_with(Add add, double reflectance = 0.6) {
  Scene scene = empty_room(reflectance);
  add(scene);
  return scene;
}

Scene with_slats() {
  return room_with([](Scene& scene) {
    add_lamp(scene);
    for (int n = 0; n < 12; ++n) add_box(scene, {1 + 0.17 * n, 1.4, 1.5}, {1.02 + 0.17 * n, 1.6, 3.5}, false);
  });
}

Scene with_a_wall_and_a_gap() {
  return room_with([](Scene& scene) {
    add_lamp(scene);
    add_box(scene, {1.9, 0.3, 0.05}, {2, 2.5, 4.95}, false);
  });
}

Scene with_a_panel_close_below_the_ceiling() {
  return room_with([](Scene& scene) {
    add_lamp(scene);
    add_box(scene, {0.3, 2.95, 0.3}, {1.3, 2.98, 2}, false);
  });
}

Scene with_a_shaded_lamp() {
  return room_with([](Scene& scene) {
    add_box(scene, {1.5, 1, 2}, {2.5, 1.02, 3}, false);
    add_polygon(scene, {{1.9, 1.3, 2.4}, {1.9, 1.3, 2.6}, {2.1, 1.3, 2.6}, {2.1, 1.3, 2.4}}, 1);  // shines up
    for (const double x : {1.7, 2.28}) add_box(scene, {x, 1.2, 2.2}, {x + 0.02, 1.7, 2.8}, false);
  });
}

Scene with_a_point_lamp() {
  return room_with([](Scene& scene) {
    add_box(scene, {1, 0, 1}, {2, 1, 3}, false);
    Light lamp;
    lamp.kind = LightKind::point;
    lamp.position = {2, 2.5, 2.5};
    lamp.intensity = {30, 30, 30};
    scene.lights = {lamp};
  });
}

Scene with_a_globe() {
  return room_with([](Scene& scene) {
    add_lamp(scene, 0.5);
    test::add_globe(scene, {2, 1, 2}, 0.6, 2, 0);
  });
}

struct NamedScene {
  const char* name;
  Scene scene;
};

std::vector<NamedScene> ten_scenes() {
  return {{"coloured room", test::coloured_room()},
          {"contacts", test::room_with_contacts()},
          {"slats", with_slats()},
          {"wall and gap", with_a_wall_and_a_gap()},
          {"panel close below the ceiling", with_a_panel_close_below_the_ceiling()},
          {"shaded lamp", with_a_shaded_lamp()},
          {"point lamp", with_a_point_lamp()},
          {"globe", with_a_globe()},
          {"white room", room_with([](Scene& scene) { add_lamp(scene); }, 0.95)},
          {"small lamp", room_with([](Scene& scene) { add_lamp(scene, 0.05); })}};
}

/// Compares solutions with path tracing at the same 1500 points.
class Truth {
 public:
  explicit Truth(const Scene& scene) : points_(draw_surface_points(scene, 1500, 5)) {
    truth_ = trace_irradiance(PathTracer(scene), points_, {.paths = 256});
  }

  /// Returns the RMS error over the mean of the truth.
  double nrmse(const DisplayMesh& solution) const {
    std::vector<ProbePoint> places;
    for (const SurfacePoint& point : points_) places.push_back({point.position, point.normal});
    const auto samples = probe(solution, places);
    std::vector<ComparedPoint> compared;
    for (std::size_t n = 0; n < places.size(); ++n)
      compared.push_back({widen(samples[n].irradiance).mean(), truth_[n].mean().mean(), truth_[n].variance_of_band_mean()});
    return error_statistics(compared).nrmse.value;
  }

 private:
  std::vector<SurfacePoint> points_;
  std::vector<IrradianceEstimate> truth_;
};

// A step later in a solve is what a larger limit of time would have shown. The limits of leaves stand for limits of time, because
// no test waits on the clock.
TEST(LongerSolves, AreNotWorseThanShorterOnes) {
  constexpr double by_chance = 1.1;  // errors of different meshes differ by chance
  // Errors differ by this through the choice of points and the noise of their truth, and because rows that are not quite
  // reciprocal make a white room too bright or too dark as a whole.
  constexpr double noise = 0.005;
  for (const auto& [name, scene] : ten_scenes()) {
    ASSERT_FALSE(find_fault(scene)) << name;
    const BaseMesh mesh(scene);
    const Truth truth(scene);
    double least = std::numeric_limits<double>::infinity();
    for (const std::uint64_t leaves : {200, 700, 2'500, 8'000, 25'000}) {
      SolutionLog log;
      solve(mesh, {.tolerance = 0.004, .max_leaves = leaves}, log, {});
      const double error = truth.nrmse(build_display_mesh(mesh, log.leaves()));
      EXPECT_LT(error, by_chance * least + noise) << name << " with " << leaves << " leaves";
      least = std::min(least, error);
    }
  }
}

}  // namespace
}  // namespace alvor
