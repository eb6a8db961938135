// Parts of the method that may be left out: faces have the same mean light without them.

#include "tests/radiosity/solve_scenes.h"
#include "tests/radiosity/solved.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace alvor {
namespace {

using test::add_box;
using test::add_polygon;
using test::grey;
using test::Solved;

/// Returns a room of 8 x 3 x 4 m. A wall leaves a passage of 0.6 m to its right half (face 12 is the floor there), where no lamp
/// is.
Scene room_behind_a_passage() {
  Scene scene;
  scene.materials = {grey(0, 0.6), grey(20, 0)};
  const auto floor = [&](double x, double X) { add_polygon(scene, {{x, 0, 0}, {x, 0, 4}, {X, 0, 4}, {X, 0, 0}}); };
  add_box(scene, {0, 0, 0}, {8, 3, 4}, true);
  scene.faces.erase(scene.faces.begin());
  add_box(scene, {3.9, 0, 0}, {4.1, 3, 3.4}, false);
  add_polygon(scene, {{1, 2.99, 1}, {2, 2.99, 1}, {2, 2.99, 2}, {1, 2.99, 2}}, 1);
  floor(4, 8);
  floor(0, 4);
  return scene;
}
constexpr std::uint32_t dark_floor = 12;

/// Returns a room in which boards stand 2 mm apart.
Scene room_with_boards() {
  Scene scene;
  scene.materials = {grey(0, 0.7), grey(10, 0)};
  add_box(scene, {0, 0, 0}, {1, 1, 1}, true);
  add_polygon(scene, {{0.25, 0.99, 0.25}, {0.75, 0.99, 0.25}, {0.75, 0.99, 0.75}, {0.25, 0.99, 0.75}}, 1);
  for (int n = 0; n < 12; ++n) add_box(scene, {0.3 + 0.03 * n, 0, 0.2}, {0.328 + 0.03 * n, 0.3, 0.8}, false);
  return scene;
}

struct Mean {
  double value, standard_error;
};

/// Returns the mean irradiance of the dark floor over solves with so many seeds.
Mean mean_over_seeds(const Scene& scene, const MethodParts& parts, int seeds) {
  double sum = 0, squares = 0;
  for (int seed = 1; seed <= seeds; ++seed) {
    const Solved solved(scene, {.tolerance = 0.05, .seed = static_cast<std::uint64_t>(seed), .parts = parts});
    const double irradiance = solved.of_face(dark_floor).mean();
    sum += irradiance, squares += irradiance * irradiance;
  }
  const double mean = sum / seeds;
  return {mean, std::sqrt((squares / seeds - mean * mean) / (seeds - 1))};
}

TEST(GuidedRays, AreNotBiasedInWholeSolves) {
  const Scene scene = room_behind_a_passage();
  const Mean guided = mean_over_seeds(scene, {}, 24), plain = mean_over_seeds(scene, {.guided_rays = false}, 24);
  EXPECT_NE(guided.value, plain.value) << "no ray is guided";
  EXPECT_LT(std::max(guided.standard_error, plain.standard_error), 0.01 * plain.value);
  EXPECT_NEAR(guided.value, plain.value, 3 * std::hypot(guided.standard_error, plain.standard_error));
}

TEST(MethodParts, LeftOutLeadToTheSameLight) {
  const std::vector<std::pair<const char*, MethodParts>> left_out{{"exact shadows", {.exact_shadows = false}},
                                                                  {"guided rays", {.guided_rays = false}},
                                                                  {"slabs", {.slabs = false}},
                                                                  {"unseen places", {.unseen_places = false}},
                                                                  {"all", {false, false, false, false}}};
  std::map<std::string, int> scenes_that_need;
  for (const Scene& scene : {test::room_with_contacts(), room_behind_a_passage(), room_with_boards()}) {
    const Solved all(scene, {.tolerance = 0.02});
    double mean = 0;
    for (std::uint32_t f = 0; f < scene.faces.size(); ++f)
      mean += all.of_face(f).mean() / static_cast<double>(scene.faces.size());
    for (const auto& [name, parts] : left_out) {
      SCOPED_TRACE(name);
      const Solved without(scene, {.tolerance = 0.02, .parts = parts});
      EXPECT_EQ(without.outcome().reason, StopReason::tolerance);
      scenes_that_need[name] += without.of_face(0).mean() != all.of_face(0).mean();
      for (std::uint32_t f = 0; f < scene.faces.size(); ++f)
        EXPECT_NEAR(without.of_face(f).mean(), all.of_face(f).mean(), 0.04 * mean) << "face " << f;
    }
  }
  for (const auto& [name, parts] : left_out) EXPECT_GT(scenes_that_need[name], 0) << name;
}

}  // namespace
}  // namespace alvor
