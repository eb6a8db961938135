#include "bench/plan/cases.h"

#include "tests/scenes.h"

namespace alvor::bench {

namespace {

enum Paint : std::uint32_t { white, lamp, red, screen };

/// Returns a room of 4 x 3 x 5 m. Its ceiling has nine tiles; the middle one is a lamp of 1 m2.
Scene empty_room() {
  Scene scene;
  scene.materials = {{"white", {}, {0.7, 0.69, 0.65}, false},
                     {"lamp", {50, 45, 38}, {0.2, 0.2, 0.2}, false},
                     {"red", {}, {0.6, 0.1, 0.05}, false},
                     {"screen", {}, {0.3, 0.4, 0.6}, true}};
  test::add_box(scene, {0, 0, 0}, {4, 3, 5}, true, {white, white, red, white, white, white});
  scene.faces.erase(scene.faces.begin() + 1);
  const double x[]{0, 1.5, 2.5, 4}, z[]{0, 2, 3, 5};
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k)
      test::add_polygon(scene, {{x[i], 3, z[k]}, {x[i + 1], 3, z[k]}, {x[i + 1], 3, z[k + 1]}, {x[i], 3, z[k + 1]}},
                        i == 1 && k == 1 ? lamp : white);
  return scene;
}

void furnish(Scene& scene) {
  test::add_box(scene, {0.7, 0, 1}, {1.7, 1.2, 2}, false);
  test::add_box(scene, {2.4, 0, 2.6}, {3.4, 0.6, 3.8}, false, {red, red, red, red, red, red});
}

/// Returns a room with every feature: colours, solids, a two-sided screen.
Scene general_room() {
  Scene scene = empty_room();
  furnish(scene);
  test::add_polygon(scene, {{0.5, 0.5, 3.6}, {1.8, 0.5, 3.3}, {1.8, 2, 3.3}, {0.5, 2, 3.6}}, screen);
  return scene;
}

Scene one_sided_room() {
  Scene scene = general_room();
  scene.materials[screen].two_sided = false;
  return scene;
}

/// Returns the scene with each material's bands replaced by their mean.
Scene grey(Scene scene) {
  for (Material& material : scene.materials) {
    material.emission = material.emission.mean() * Rgb{1, 1, 1};
    material.reflectance = material.reflectance.mean() * Rgb{1, 1, 1};
  }
  return scene;
}

Scene scaled_reflectance(Scene scene, double scale) {
  for (Material& material : scene.materials) material.reflectance *= scale;
  return scene;
}

/// Returns two walls, a floor and a luminous panel under the open sky.
Scene open_corner() {
  Scene scene = empty_room();
  scene.faces.clear();
  test::add_polygon(scene, {{0, 0, 0}, {0, 0, 5}, {4, 0, 5}, {4, 0, 0}}, white);
  test::add_polygon(scene, {{0, 0, 0}, {0, 3, 0}, {0, 3, 5}, {0, 0, 5}}, red);
  test::add_polygon(scene, {{0, 0, 0}, {4, 0, 0}, {4, 3, 0}, {0, 3, 0}}, white);
  test::add_polygon(scene, {{1.5, 3, 2}, {2.5, 3, 2}, {2.5, 3, 3}, {1.5, 3, 3}}, lamp);
  return scene;
}

/// Returns the furnished room with outer walls and a similar room without light.
Scene house() {
  Scene scene = general_room();
  test::add_box(scene, {4.3, 0, 0}, {8.3, 3, 5}, true);
  test::add_box(scene, {5.3, 0, 1}, {6.3, 1, 2}, false);
  test::add_box(scene, {-0.3, -0.3, -0.3}, {8.6, 3.3, 5.3}, false);
  return scene;
}

}  // namespace

std::vector<PlanCase> plan_cases() {
  const SolveOptions usual{.tolerance = 0.02, .threads = 1};
  SolveOptions flat = usual;
  flat.max_depth = 0;
  flat.tolerance = 0.002;
  Scene unlit = general_room();
  unlit.materials[lamp].emission = {};
  return {
      {"general", "a furnished room: colours, solids, a two-sided screen", general_room(), usual, {}},
      {"grey", "the same, all spectra their mean", grey(general_room()), usual, {Feature::three_bands}},
      {"one-sided", "the same, the screen seen from one side", one_sided_room(), usual, {Feature::back_sides}},
      {"clear", "the same, with no medium", one_sided_room(), usual, {Feature::medium}},
      {"opaque", "the same, with nothing to look through", one_sided_room(), usual, {Feature::panes}},
      {"faint", "the same, a fifth of the reflectance", scaled_reflectance(general_room(), 0.2), usual, {Feature::acceleration}},
      {"black", "the same, no reflectance", scaled_reflectance(general_room(), 0), usual, {Feature::indirect_rows}},
      {"house", "the same, with outer walls and a room without light", house(), usual, {Feature::dark_faces}},
      {"flat", "the same, to 0.2 % without splits", general_room(), flat, {Feature::refinement}},
      {"unlit", "the same, the lamp switched off", unlit, usual, {}},
      {"convex", "the room, empty", empty_room(), usual, {Feature::occlusion}},
      {"open", "a corner without a room: floor, two walls, a lamp", open_corner(), usual, {Feature::occlusion}},
      {"grey-convex", "the room, empty and grey", grey(empty_room()), usual, {Feature::occlusion, Feature::three_bands}},
      {"black-convex",
       "the room, empty and black",
       scaled_reflectance(empty_room(), 0),
       usual,
       {Feature::occlusion, Feature::indirect_rows}},
  };
}

}  // namespace alvor::bench
