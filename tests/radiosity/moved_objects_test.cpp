// Objects that are moved and hidden while a scene is solved.

#include "meshing/edit/edited_scene.h"
#include "radiosity/solve/moved_roots.h"
#include "tests/radiosity/edited_solve.h"
#include "tests/scenes.h"
#include "tests/textures.h"

#include <gtest/gtest.h>

#include <memory>
#include <random>

namespace alvor {
namespace {

using test::EditedSolve, test::difference_of_roots;

TEST(MovedObjects, FewRaysAreSentAgain) {
  Scene submitted = test::room_of_objects();
  const auto first = static_cast<std::uint32_t>(submitted.faces.size());
  test::add_box(submitted, {2.5, 0.5, 3}, {2.7, 0.7, 3.2}, false);
  submitted.objects.push_back({.name = "cube", .first_face = first, .face_count = 6});
  EditedSolve solve(submitted, {.tolerance = 0.02, .max_leaves = 100'000});
  const Step fresh = solve.last();
  // Up to the first estimate after the edit.
  const auto rays_of = [&](const ObjectEdit& edit) {
    const Step before = solve.last();
    solve.edit([&](Scene& scene) { scene = edited_scene(submitted, std::vector<SceneEdit>{edit}); });
    const auto steps = solve.log().steps();
    const auto told =
        std::ranges::find_if(steps, [&](const Step& step) { return step.edits > before.edits && !step.is_provisional; });
    return static_cast<double>(told->rays - before.rays) / static_cast<double>(fresh.rays);
  };
  EXPECT_LT(rays_of({.name = "cube", .move = Vec3{0.5, 0.3, 0.5}}), 0.3);
  EXPECT_LT(rays_of({.name = "cube", .move = Vec3{0.5, 0.3, 0.6}}), 0.3);
  EXPECT_LT(rays_of({.name = "cube", .hidden = true}), 0.3);
  EXPECT_LT(rays_of({.name = "cube", .dim = 1}), 0.3);
}

TEST(MovedObjects, OfALampThatIsSwitchedOffOnlyWhatIsNeededIsRefined) {
  Scene submitted = test::room_of_objects();
  submitted.objects.push_back(
      {.name = "second lamp", .first_face = static_cast<std::uint32_t>(submitted.faces.size()), .face_count = 1});
  test::add_polygon(submitted, {{0.2, 2.99, 3.8}, {1.2, 2.99, 3.8}, {1.2, 2.99, 4.8}, {0.2, 2.99, 4.8}}, 1);
  const SolveOptions options{.tolerance = 0.02, .max_leaves = 200'000};
  EditedSolve solve(submitted, options);
  const Step before = solve.last();
  solve.edit(
      [&](Scene& scene) { scene = edited_scene(submitted, std::vector<SceneEdit>{ObjectEdit{.name = "lamp", .dim = 0}}); });
  EXPECT_LE(solve.last().estimated_error, options.tolerance);
  const EditedSolve anew(submitted, options, solve.scene());
  // The room is lit by the other lamp alone then, which takes other leaves: more than the first solve has, in a new solve.
  EXPECT_LT(static_cast<double>(solve.last().rays - before.rays), 0.45 * static_cast<double>(anew.last().rays));
  EXPECT_LT(difference_of_roots(solve, anew), solve.last().estimated_error + anew.last().estimated_error);
}

TEST(MovedObjects, WhatIsHiddenFromTheFirstCanBeShown) {
  const Scene submitted = test::room_of_objects();
  const Scene without = edited_scene(submitted, std::vector<SceneEdit>{ObjectEdit{.name = "box", .hidden = true}});
  const SolveOptions options{.tolerance = 0.03, .max_leaves = 20'000};
  EditedSolve solve(submitted, options, without);
  solve.edit([&](Scene& scene) { scene = submitted; });
  const EditedSolve anew(submitted, options);
  EXPECT_LT(difference_of_roots(solve, anew), solve.last().estimated_error + anew.last().estimated_error);
}

TEST(MovedObjects, ACopyIsLitAsAnObjectThatWasSubmittedThereAndGoesWhenItIsTakenBack) {
  const Scene submitted = test::room_of_objects();
  const SolveOptions options{.tolerance = 0.03, .max_leaves = 20'000};
  EditedSolve solve(submitted, options);
  const Vec3 by{1.2, 0.3, 1};
  const auto edit = [&](bool is_taken_back) {
    std::vector<SceneEdit> edits{ObjectCopy{"second box", "box", is_taken_back}};
    if (!is_taken_back) edits.push_back(ObjectEdit{.name = "second box", .move = by});
    solve.edit([&](Scene& scene) { scene = edited_scene(submitted, edits); });
  };
  const auto roots = static_cast<std::uint32_t>(solve.mesh().roots().size());
  const double before = mean_irradiance(solve, roots);
  edit(false);
  // The scene with the second box submitted as further faces. They come after all others, as those of the copy do.
  Scene with = submitted;
  for (std::uint32_t k = 0; k < submitted.objects[2].face_count; ++k) {
    std::vector<Vec3> corners;
    const Face face = submitted.faces[submitted.objects[2].first_face + k];
    for (const std::uint32_t vertex : submitted.corners_of(face)) corners.push_back(submitted.vertices[vertex] + by);
    with.add_polygon(corners, face.material);
  }
  const EditedSolve anew(with, options);
  ASSERT_EQ(solve.mesh().roots().size(), anew.mesh().roots().size());
  EXPECT_LT(difference_of_roots(solve, anew), solve.last().estimated_error + anew.last().estimated_error);
  EXPECT_GT(std::abs(mean_irradiance(solve, roots) - before), 0.002 * before) << "the box takes light away";
  edit(true);
  for (const LeafValue& leaf : solve.leaves()) EXPECT_TRUE(leaf.patch.root_face() < roots || leaf.irradiance.max() == 0);
  EXPECT_NEAR(mean_irradiance(solve, roots), before, 0.04 * before);
}

/// Returns a table with a lamp on it, as a scene of its own.
Scene table_with_lamp() {
  Scene table;
  table.materials = {test::grey(0, 0.4), test::grey(30, 0)};
  test::add_box(table, {0, 0.7, 0}, {0.8, 0.75, 0.6}, false);
  test::add_polygon(table, {{0.3, 0.9, 0.2}, {0.5, 0.9, 0.2}, {0.5, 0.9, 0.4}, {0.3, 0.9, 0.4}}, 1);
  return table;
}

struct Addition {
  std::string name;
  SceneEdit edit;
  Vec3 move;
  AddedScenes scenes;
  AddedMeshes meshes;
  bool shines;
};

std::vector<Addition> additions() {
  const auto table = std::make_shared<const Scene>(table_with_lamp());
  const auto mesh = std::make_shared<const BaseMesh>(*table);
  Scene lamp = *table;
  lamp.faces.pop_back();
  lamp.lights = {Light{"spot", LightKind::spot, {2, 2, 2}, {0.4, 1.2, 0.3}}};
  lamp.lights[0].direction = {0, -1, 0};
  const auto lit = std::make_shared<const Scene>(std::move(lamp));
  Scene patterned = *table;
  patterned.materials[0] = test::textured(test::checkerboard(4, 10, 200));
  test::complete_texture_points(patterned);
  const auto checked = std::make_shared<const Scene>(std::move(patterned));
  return {{"second box", ObjectCopy{"second box", "box"}, {0.8, 0.3, 1}, {}, {}, false},
          {"second lamp", ObjectCopy{"second lamp", "lamp"}, {1.2, -0.3, 1}, {}, {}, true},
          {"table",
           ObjectCopy{.name = "table", .of = "", .scene = "scenes/table"},
           {1.2, 0, 1},
           {{"scenes/table", table}},
           {{"scenes/table", mesh}},
           true},
          {"lit table",
           ObjectCopy{.name = "lit table", .of = "", .scene = "scenes/lit"},
           {1.2, 0, 1},
           {{"scenes/lit", lit}},
           {{"scenes/lit", std::make_shared<const BaseMesh>(*lit)}},
           true},
          {"checked table",
           ObjectCopy{.name = "checked table", .of = "", .scene = "scenes/checked"},
           {1.2, 0, 1},
           {{"scenes/checked", checked}},
           {{"scenes/checked", std::make_shared<const BaseMesh>(*checked)}},
           true}};
}

// A bulb is a light that is no face. Its number comes after those of all roots, of which there are more then.
TEST(MovedObjects, WhatIsAddedCostsFewRaysAndIsLitAsInASolveThatBeginsWithIt) {
  for (const bool has_bulb : {false, true})
    for (const Addition& addition : additions()) {
      SCOPED_TRACE(addition.name + (has_bulb ? " with a bulb" : ""));
      Scene submitted = test::room_of_objects();
      if (has_bulb) submitted.lights = {Light{"bulb", LightKind::point, {2, 2, 2}, {1, 2, 4}}};
      const SolveOptions options{.tolerance = 0.03, .max_leaves = 40'000};
      EditedSolve solve(submitted, options);
      const Step before = solve.last();
      const std::vector<SceneEdit> edits{addition.edit, ObjectEdit{.name = addition.name, .move = addition.move}};
      ASSERT_FALSE(fault_in(edits, submitted, addition.scenes));
      solve.edit([&](Scene& scene) { scene = edited_scene(submitted, edits, addition.scenes); }, addition.meshes);
      const auto steps = solve.log().steps();
      const auto first = std::ranges::find_if(steps, [&](const Step& step) { return step.edits > before.edits; });
      ASSERT_NE(first, steps.end());
      EXPECT_TRUE(first->is_provisional) << "what was known is shown at once";
      const EditedSolve anew(submitted, options, solve.scene(), addition.meshes);
      const auto told = std::find_if(first, steps.end(), [](const Step& step) { return !step.is_provisional; });
      const auto rays = static_cast<double>(told->rays - before.rays);
      EXPECT_LT(rays, (addition.shines ? 0.6 : 0.3) * static_cast<double>(anew.last().rays)) << "up to the first estimate";
      EXPECT_LT(difference_of_roots(solve, anew), solve.last().estimated_error + anew.last().estimated_error);
    }
}

/// Two closed rooms of eight lamps each; in one of them stands a box. With so many lamps, it is not known what each of them
/// brings.
TEST(MovedObjects, AmongManyLampsWhatDoesNotSeeThemIsNotLitAnew) {
  Scene submitted;
  submitted.materials = {test::grey(0, 0.5), test::grey(1, 0)};
  for (const double x : {0.0, 10.0}) {
    test::add_box(submitted, {x, 0, 0}, {x + 4, 3, 4}, true);
    for (int lamp = 0; lamp < 8; ++lamp) {
      const double low = x + 0.4 + 0.9 * (lamp % 4), z = lamp < 4 ? 1 : 3;
      test::add_polygon(submitted, {{low, 2.9, z}, {low + 0.3, 2.9, z}, {low + 0.3, 2.9, z + 0.3}, {low, 2.9, z + 0.3}}, 1);
    }
  }
  const auto roots_of_other_room = static_cast<std::uint32_t>(submitted.faces.size()) / 2;
  submitted.objects = {{.name = "box", .first_face = static_cast<std::uint32_t>(submitted.faces.size()), .face_count = 6}};
  test::add_box(submitted, {1, 0.5, 1}, {1.5, 1, 1.5}, false);
  // After the edit the error is below the tolerance again without refining, which would change the other room, too.
  const SolveOptions options{.tolerance = 0.04, .max_leaves = 20'000};
  EditedSolve solve(submitted, options);
  const auto of_other_room = [&] {
    std::vector<LeafValue> leaves = solve.leaves();
    std::erase_if(leaves, [&](const LeafValue& leaf) {
      return leaf.patch.root_face() < roots_of_other_room || leaf.patch.root_face() >= 2 * roots_of_other_room;
    });
    return leaves;
  };
  const auto before = of_other_room();
  const std::uint64_t rays = solve.last().rays;
  solve.edit([&](Scene& scene) {
    scene = edited_scene(submitted, std::vector<SceneEdit>{ObjectEdit{.name = "box", .move = Vec3{1, 0.2, 1}}});
  });
  EXPECT_LT(test::difference(of_other_room(), before), 1e-6);
  EXPECT_LT(static_cast<double>(solve.last().rays - rays), 0.6 * static_cast<double>(rays));
  const EditedSolve anew(submitted, options, solve.scene());
  EXPECT_LT(difference_of_roots(solve, anew), solve.last().estimated_error + anew.last().estimated_error);
}

/// A sheet of one side lies above the floor, where its back hides what is below it, and is moved or taken away.
TEST(MovedObjects, WhatASheetOfOneSideHidIsSeenAgain) {
  Scene submitted = test::coloured_room();
  submitted.objects = {{.name = "sheet", .first_face = static_cast<std::uint32_t>(submitted.faces.size()), .face_count = 1}};
  test::add_polygon(submitted, {{2.4, 0.3, 3.2}, {2.4, 0.3, 4.2}, {3.4, 0.3, 4.2}, {3.4, 0.3, 3.2}}, 0);
  const SolveOptions unsplit{.tolerance = 1e-6, .max_depth = 3, .max_leaves = 3000};
  for (const ObjectEdit& edit :
       {ObjectEdit{.name = "sheet", .hidden = true}, ObjectEdit{.name = "sheet", .move = Vec3{0, 1, -1}}}) {
    EditedSolve solve(submitted, unsplit);
    solve.edit([&](Scene& scene) { scene = edited_scene(submitted, std::vector<SceneEdit>{edit}); });
    const EditedSolve anew(submitted, unsplit, solve.scene());
    EXPECT_LT(difference_of_roots(solve, anew), 0.01);
  }
}

/// Returns an edit of an object, a material or the lamp's brightness.
SceneEdit any_edit(std::mt19937& random) {
  const auto uniform = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
  const std::string object = random() % 2 ? "box" : "block";
  switch (random() % 6) {
    case 0: return ObjectEdit{.name = object, .move = Vec3{uniform(-1, 1), uniform(0, 0.5), uniform(-1, 2)}};
    case 1: return ObjectEdit{.name = object, .turn = uniform(-180, 180)};
    case 2: return ObjectEdit{.name = object, .hidden = random() % 2 == 0};
    case 3: return ObjectEdit{.name = "lamp", .move = Vec3{uniform(-1, 1), uniform(-0.5, 0), uniform(-1, 1)}};
    case 4: return MaterialEdit{.name = "m0", .reflectance = Rgb{uniform(0, 0.9), uniform(0, 0.9), uniform(0, 0.9)}};
    default: return ObjectEdit{.name = "lamp", .dim = uniform(0.1, 2)};
  }
}

TEST(MovedObjects, AfterManyEditsASolveIsWithinWhatItTellsOfANewOne) {
  const SolveOptions options{.tolerance = 0.05, .max_leaves = 20'000};
  const Scene submitted = test::room_of_objects();
  std::mt19937 random(5);
  EditedSolve solve(submitted, options);
  std::vector<SceneEdit> edits;
  int compared = 0, within = 0;
  for (int n = 1; n <= 60; ++n) {
    edits.push_back(any_edit(random));
    ASSERT_FALSE(fault_in(edits, submitted));
    solve.edit([&](Scene& scene) { scene = edited_scene(submitted, edits); });
    EXPECT_EQ(solve.last().edits, static_cast<std::uint64_t>(n));
    if (n % 5 != 0) continue;
    const EditedSolve anew(submitted, options, solve.scene());
    within += difference_of_roots(solve, anew) < solve.last().estimated_error + anew.last().estimated_error;
    ++compared;
  }
  EXPECT_GE(within, compared - 1);  // told errors hold nine times of ten
  solve.edit([&](Scene& scene) { scene = submitted; });
  const EditedSolve first(submitted, options);
  EXPECT_LT(difference_of_roots(solve, first), solve.last().estimated_error + first.last().estimated_error);
}

TEST(MovedRoots, NoWayThroughABoxIsMissed) {
  const Scene submitted = test::room_of_objects();
  const BaseMesh before(submitted);
  const BaseMesh after =
      before.edited_as(edited_scene(submitted, std::vector<SceneEdit>{ObjectEdit{.name = "box", .move = Vec3{0.3, 0.2, 2}}}));
  const MovedRoots moved(before, after);
  std::mt19937 random(3);
  const auto uniform = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
  const auto in_sphere = [&](double radius) {
    const Vec3 p{uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
    return radius * uniform(0, 1) * normalized(p);
  };
  std::vector<std::uint32_t> roots;
  for (std::uint32_t root = 0; root < before.roots().size(); ++root)
    if (moved.has(root)) roots.push_back(root);
  ASSERT_EQ(roots.size(), 6u);
  for (int n = 0; n < 20'000; ++n) {
    // A way through a point of the object, begun and ended in spheres.
    const bool is_old = random() % 2;
    const RootPatch& root = (is_old ? before : after).roots()[roots[random() % roots.size()]];
    const Vec3 through = root.at(uniform(0, 1), uniform(0, 1));
    const Vec3 start{uniform(0, 4), uniform(0, 3), uniform(0, 5)}, end = start + uniform(1, 3) * (through - start);
    const double small = uniform(0, 0.1), large = uniform(0, 1);
    EXPECT_TRUE(moved.may_meet(start + in_sphere(small), small, end + in_sphere(large), large));
    EXPECT_TRUE(is_old || moved.may_meet_now(start + in_sphere(small), end, small));
  }
  EXPECT_FALSE(moved.may_meet({0.1, 0.1, 0.1}, 0.05, {0.1, 2.9, 0.1}, 0.05));
}

}  // namespace
}  // namespace alvor
