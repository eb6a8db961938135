// Edits of materials and lights: a solve goes on from what it knows, and ends where a solve of the edited scene ends.

#include "meshing/edit/edited_scene.h"
#include "meshing/patch_place.h"
#include "tests/radiosity/edited_solve.h"
#include "tests/radiosity/solve_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>

namespace alvor {
namespace {

using test::Change, test::EditedSolve, test::difference, test::difference_of_roots;

/// Returns a room with two lamps of different materials, so that each can be dimmed.
Scene room_with_two_lamps() {
  Scene scene = test::room_with_contacts();
  scene.materials.push_back(test::grey(30, 0));
  test::add_polygon(scene, {{0.3, 2.9, 0.5}, {0.6, 2.9, 0.5}, {0.6, 2.9, 1}, {0.3, 2.9, 1}},
                    static_cast<std::uint32_t>(scene.materials.size() - 1));
  return scene;
}

// No leaf is split, so that the edited solve and a new one have the same leaves and, from the same seed, the same rows.
const SolveOptions unsplit{.tolerance = 1e-6, .max_depth = 0};

Change of_object(const ObjectEdit& edit) {
  return [edit](Scene& scene) { scene = edited_scene(scene, std::vector<SceneEdit>{edit}); };
}

Change of_daylight(const Daylight& daylight) {
  return [daylight](Scene& scene) { scene = edited_scene(scene, std::vector<SceneEdit>{DaylightEdit{daylight}}); };
}
Scene room_with_lamps() {
  Scene scene = test::room_with_lamps_and_sun();
  scene.lights.pop_back();
  return scene;
}
Scene room_in_the_morning() {
  Scene scene = room_with_lamps();
  of_daylight({.sun = SunPosition{120, 60}, .sky = Daylight::Sky::cie, .cie_number = 12, .ground_reflectance = 0.2})(scene);
  return scene;
}

Scene room_of_objects_and_many_lamps() {
  Scene scene = test::room_of_objects();
  const auto shining = static_cast<std::uint32_t>(scene.materials.size());
  scene.materials.push_back(test::grey(9, 0));
  for (int n = 0; n < 14; ++n) {
    const double x = 0.3 + 0.25 * n;
    test::add_polygon(scene, {{x, 2.9, 0.5}, {x + 0.1, 2.9, 0.5}, {x + 0.1, 2.9, 1}, {x, 2.9, 1}}, shining);
  }
  return scene;
}
/// A box on the ground, under the open sky.
Scene box_under_the_sky() {
  Scene scene;
  scene.materials.push_back(test::grey(0, 0.5));
  test::add_polygon(scene, {{-3, 0, -3}, {-3, 0, 3}, {3, 0, 3}, {3, 0, -3}}, 0);
  scene.objects = {{.name = "box", .first_face = 1, .face_count = 6}};
  test::add_box(scene, {-1, 0.1, -1}, {0, 1, 0}, false);
  of_daylight({.sky = Daylight::Sky::cie, .cie_number = 1})(scene);
  return scene;
}

/// The sky comes before the other lights, and is black.
Scene closed_room_under_a_black_sky() {
  Scene scene = test::coloured_room();
  scene.lights = room_in_the_morning().lights;
  std::ranges::reverse(scene.lights);
  scene.lights[0].intensity = {};
  return scene;
}

/// A luminaire hangs from the ceiling and shines down, the more the wider `spread` is.
Scene room_with_luminaire(double spread) {
  Scene scene = test::coloured_room();
  auto web = std::make_shared<PhotometricWeb>();
  web->planes = {0};
  web->angles = {0, spread, 2 * spread};
  web->intensities = {90, 60, 0};
  Light luminaire{"luminaire", LightKind::luminaire, {0.1, 0.1, 0.1}, {1, 2.5, 1}, {0, -1, 0}};
  luminaire.across = {1, 0, 0};
  luminaire.opening = {LuminousOpening::Shape::rectangle, 0.3, 0.3, 0};
  luminaire.web = web;
  scene.lights = {luminaire};
  return scene;
}

/// A pane stands across the room.
Scene room_with_pane() {
  Scene scene = test::coloured_room();
  Material glass = test::grey(0, 0.05);
  glass.two_sided = true;
  glass.regular_transmittance = {0.8, 0.8, 0.7};
  scene.materials.push_back(glass);
  test::add_polygon(scene, {{0.2, 0.2, 3.5}, {3.8, 0.2, 3.5}, {3.8, 2.5, 3.5}, {0.2, 2.5, 3.5}},
                    static_cast<std::uint32_t>(scene.materials.size() - 1));
  return scene;
}

struct Case {
  std::string name;
  Scene (*scene)();
  Change change;
};
void PrintTo(const Case& one, std::ostream* out) { *out << one.name; }

class Edit : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(
    Cases, Edit,
    testing::Values(Case{"Reflectance", test::coloured_room,
                         [](Scene& s) {
                           s.materials[0].reflectance = {0.1, 0.7, 0.3};
                         }},
                    Case{"ReflectanceOfGreyRoom", room_with_two_lamps,
                         [](Scene& s) {
                           s.materials[0].reflectance = {0.2, 0.5, 0.8};
                         }},
                    Case{"Emission", test::coloured_room,
                         [](Scene& s) {
                           s.materials[1].emission = {1, 5, 9};
                         }},
                    Case{"OneOfTwoLamps", room_with_two_lamps,
                         [](Scene& s) {
                           s.materials.back().emission = {0, 10, 20};
                         }},
                    Case{"ALampIsSwitchedOff", room_with_two_lamps, [](Scene& s) { s.materials.back().emission = {}; }},
                    Case{"AWallBeginsToShine", room_with_two_lamps,
                         [](Scene& s) {
                           s.materials[2].emission = {3, 2, 1};
                         }},
                    Case{"ABulb", test::room_with_lamps_and_sun,
                         [](Scene& s) {
                           s.lights[0].intensity = {1, 1, 20};
                         }},
                    Case{"ABulbMoves", test::room_with_lamps_and_sun,
                         [](Scene& s) {
                           s.lights[0].position = {1, 1.5, 1};
                         }},
                    Case{"ASpotTurns", test::room_with_lamps_and_sun,
                         [](Scene& s) {
                           s.lights[1].direction = normalized(Vec3{0.5, -1, 0.7});
                         }},
                    Case{"ASpotGetsAnotherCone", test::room_with_lamps_and_sun,
                         [](Scene& s) { s.lights[1].inner_cone = 0.2, s.lights[1].outer_cone = 0.5; }},
                    Case{"ALuminaireGetsAnotherWeb", [] { return room_with_luminaire(30); },
                         [](Scene& s) { s.lights = room_with_luminaire(20).lights; }},
                    Case{"AirTurnsHazy", test::room_with_lamps_and_sun,
                         [](Scene& s) {
                           s.absorption = {0.1, 0.05, 0.02};
                         }},
                    Case{"GlassDarkens", room_with_pane,
                         [](Scene& s) {
                           s.materials.back().regular_transmittance = {0.3, 0.4, 0.2};
                         }},
                    Case{"GlassIsPainted", room_with_pane, [](Scene& s) { s.materials.back().regular_transmittance = {}; }},
                    Case{"AWallBecomesGlass",
                         [] {
                           Scene scene = room_with_pane();
                           scene.materials.back().regular_transmittance = {};
                           return scene;
                         },
                         [](Scene& s) {
                           s.materials.back().regular_transmittance = {0.5, 0.6, 0.7};
                         }},
                    Case{"TheSunTurnsRed",
                         [] {
                           Scene scene = test::room_with_lamps_and_sun();
                           scene.lights = {scene.lights[2]};
                           for (Material& material : scene.materials) material.emission = {};
                           return scene;
                         },
                         [](Scene& s) {
                           s.lights[0].intensity = {60, 10, 1};
                         }},
                    Case{"TheSunGoesOn", test::room_with_lamps_and_sun,
                         [](Scene& s) {
                           s.lights[2].direction = normalized(Vec3{-0.3, -1, 0.3});
                         }},
                    Case{"ASunAndASkyComeUp", room_with_lamps,
                         of_daylight({.sun = SunPosition{200, 60}, .sky = Daylight::Sky::cie, .cie_number = 12})},
                    Case{"TheSunGoesOnUnderASky", room_in_the_morning,
                         of_daylight({.sun = SunPosition{170, 62}, .sky = Daylight::Sky::cie, .cie_number = 12})},
                    Case{"NightFalls", room_in_the_morning, of_daylight({})},
                    Case{"ManyLamps", test::room_with_many_lamps,
                         [](Scene& s) {
                           s.materials[1].emission = {3, 3, 3};
                         }},
                    Case{"Curtain", test::curtained_room,
                         [](Scene& s) {
                           s.materials[3].diffuse_transmittance = {0.1, 0.1, 0.5};
                         }},
                    Case{"ABoxMoves", test::room_of_objects, of_object({.name = "box", .move = Vec3{0.3, 0, 1.7}})},
                    Case{"ABoxTurnsAndStaysOnTheFloor", test::room_of_objects, of_object({.name = "box", .turn = 30})},
                    Case{"ABoxIsLiftedOffTheFloor", test::room_of_objects, of_object({.name = "box", .move = Vec3{0, 0.4, 0}})},
                    Case{"ABoxGrows", test::room_of_objects, of_object({.name = "box", .move = Vec3{0, 0.6, 1.5}, .scale = 1.5})},
                    Case{"ABoxTips", test::room_of_objects,
                         of_object({.name = "box", .move = Vec3{0, 0.8, 1}, .turn = 40, .turn_axis = Vec3{1, 0, 0.2}})},
                    Case{"ALampShrinks", test::room_of_objects, of_object({.name = "lamp", .scale = 0.5})},
                    Case{"ABoxIsHidden", test::room_of_objects, of_object({.name = "box", .hidden = true})},
                    Case{"ALampMoves", test::room_of_objects, of_object({.name = "lamp", .move = Vec3{-0.8, -0.3, 1}})},
                    Case{"ABoxMovesAmongManyLamps", room_of_objects_and_many_lamps,
                         of_object({.name = "box", .move = Vec3{0.3, 0.2, 1.7}})},
                    Case{"ABoxMovesUnderTheSky", box_under_the_sky, of_object({.name = "box", .move = Vec3{1, 0.2, 0.7}})},
                    Case{"AllSurfacesShineLessBesideASun",
                         [] {
                           Scene scene = test::furnace(1, 0.5);
                           scene.lights = {{"sun", LightKind::directional, {5, 5, 5}, {}, {0, -1, 0}}};
                           return scene;
                         },
                         [](Scene& s) {
                           s.materials[0].emission = {0.3, 0.3, 0.3};
                         }},
                    Case{"ALampMovesUnderABlackSky", closed_room_under_a_black_sky,
                         [](Scene& s) { std::ranges::find(s.lights, LightKind::point, &Light::kind)->position = {1, 1.5, 1}; }},
                    Case{"AllSurfacesShine", [] { return test::furnace(1, 0.5); },
                         [](Scene& s) {
                           s.materials[0].reflectance = {0.2, 0.4, 0.6};
                         }}),
    [](const auto& one) { return one.param.name; });

TEST_P(Edit, EndsWhereASolveOfTheEditedSceneEnds) {
  EditedSolve edited(GetParam().scene(), unsplit);
  edited.edit(GetParam().change);
  const EditedSolve anew(edited.scene(), unsplit);
  EXPECT_LT(difference(edited.leaves(), anew.leaves()), 2e-5);
  EXPECT_EQ(edited.last().edits, 1u);
  EXPECT_FALSE(edited.last().is_provisional);
}

TEST_P(Edit, TakenBackLeadsToTheFirstState) {
  const Scene first = GetParam().scene();
  EditedSolve edited(first, unsplit);
  const auto before = edited.leaves();
  edited.edit(GetParam().change);
  edited.edit([&](Scene& scene) { scene = first; });
  EXPECT_LT(difference(edited.leaves(), before), 2e-5);
}

TEST_P(Edit, WithinWhatBothEstimatesSayWhereLeavesAreSplit) {
  const SolveOptions options{.tolerance = 0.03, .max_leaves = 20'000};
  EditedSolve edited(GetParam().scene(), options);
  edited.edit(GetParam().change);
  const EditedSolve anew(edited.scene(), options);
  EXPECT_LT(difference_of_roots(edited, anew), edited.last().estimated_error + anew.last().estimated_error);
}

TEST_P(Edit, KeepingWhatEditsNeedChangesNoBit) {
  const SolveOptions options{.tolerance = 0.04, .max_leaves = 20'000};
  const BaseMesh mesh(GetParam().scene());
  EditedSolve kept(GetParam().scene(), options);
  SolutionLog log;
  solve(mesh, options, log, {});
  EXPECT_EQ(kept.leaves(), log.leaves());
  EXPECT_EQ(kept.last().estimated_error, log.last_step().estimated_error);
  const auto errors_of = [](const SolutionLog& of) { return of.since({.errors = {.are_wanted = true}}).errors.value().codes; };
  EXPECT_EQ(errors_of(kept.log()), errors_of(log));
}

TEST(EditedSolve, RecoloursAndDimsAllLampsWithoutARay) {
  EditedSolve edited(test::coloured_room(), {.tolerance = 0.05});
  const std::uint64_t rays = edited.last().rays;
  const auto before = edited.leaves();
  edited.edit([](Scene& scene) { scene.materials[1].emission = 0.5 * scene.materials[1].emission; });
  EXPECT_EQ(edited.last().rays, rays);
  auto half = before;
  for (LeafValue& leaf : half) leaf.irradiance = 0.5f * leaf.irradiance;
  EXPECT_LT(difference(edited.leaves(), half), 1e-5);
}

// The faces of a room whose lamp is off show nothing, and then their light again, each leaf its own.
TEST(EditedSolve, ARoomIsDarkAndLitAgainAsItWas) {
  Scene scene;
  scene.materials = {test::grey(0, 0.5), test::grey(20, 0), test::grey(30, 0)};
  for (const std::uint32_t room : {0u, 1u}) {
    const double x = 10 * room;
    test::add_box(scene, {x, 0, 0}, {x + 4, 3, 4}, true);
    test::add_polygon(scene, {{x + 1, 2.9, 1}, {x + 1.5, 2.9, 1}, {x + 1.5, 2.9, 1.5}, {x + 1, 2.9, 1.5}}, 1 + room);
  }
  EditedSolve edited(scene, {.tolerance = 0.05, .max_leaves = 20'000});
  const auto before = edited.leaves();
  edited.edit([](Scene& off) { off.materials[1].emission = {}; });
  EXPECT_LT(mean_irradiance(edited, scene.faces.size() / 2), 1e-6);
  edited.edit([&](Scene& on) { on = scene; });
  EXPECT_LT(difference(edited.leaves(), before), 1e-3);
}

TEST(EditedSolve, TellsTheSameErrorsOfAMultipleOfTheLightAtOnce) {
  EditedSolve edited(test::coloured_room(), {.tolerance = 0.05});
  const Step before = edited.last();
  const auto errors = [&] { return edited.log().since({.errors = {.are_wanted = true}}).errors.value(); };
  const auto told = errors();
  const double absorbed = edited.outcome.balance.absorbed;
  edited.edit([](Scene& scene) { scene.materials[1].emission = 0.25 * scene.materials[1].emission; });
  EXPECT_EQ(edited.last().revision, before.revision + 1) << "one state more, and no other";
  EXPECT_EQ(edited.last().estimated_error, before.estimated_error);
  EXPECT_FALSE(edited.last().is_provisional);
  EXPECT_EQ(edited.outcome.reason, StopReason::tolerance);
  EXPECT_NEAR(edited.outcome.balance.absorbed, 0.25 * absorbed, 1e-9 * absorbed);
  EXPECT_EQ(errors().codes, told.codes);
  EXPECT_EQ(errors().coding.scale(), told.coding.scale() - 2) << "a quarter of the light, a quarter of the error";
}

TEST(EditedSolve, DimsOneOfTwoLampsWithoutARayAndShowsItBeforeLightHasGoneRound) {
  EditedSolve edited(room_with_two_lamps(), {.tolerance = 0.06});
  const Step before = edited.last();
  edited.edit([](Scene& scene) { scene.materials.back().emission = {15, 15, 15}; });
  const auto steps = edited.log().steps();
  const Step& first = steps.at(before.revision);
  EXPECT_EQ(first.rays, before.rays);
  EXPECT_TRUE(first.is_provisional);
  EXPECT_EQ(first.edits, 1u);
  EXPECT_GT(first.estimated_error, 0.06);  // it does not claim what it does not know yet
  EXPECT_FALSE(edited.last().is_provisional);
  EXPECT_LE(edited.last().estimated_error, 0.06);
}

TEST(EditedSolve, RecoloursWithoutARayUpToTheFirstCompleteState) {
  EditedSolve edited(room_with_two_lamps(), {.tolerance = 0.05});
  const Step before = edited.last();
  edited.edit([](Scene& scene) { scene.materials[0].reflectance = {0.3, 0.2, 0.6}; });
  const auto steps = edited.log().steps();
  const auto first = std::find_if(steps.begin() + static_cast<std::ptrdiff_t>(before.revision), steps.end(),
                                  [](const Step& step) { return !step.is_provisional; });
  ASSERT_NE(first, steps.end());
  EXPECT_EQ(first->rays, before.rays);
}

TEST(EditedSolve, BeginsAnewWhereNothingReflectedAndShowsNoDarknessMeanwhile) {
  EditedSolve edited(test::black_room(), {.tolerance = 0.05});
  const Step before = edited.last();
  edited.edit([](Scene& scene) {
    for (Material& material : scene.materials) material.reflectance = {0.5, 0.5, 0.5};
  });
  const EditedSolve anew(edited.scene(), {.tolerance = 0.05});
  const auto steps = edited.log().steps();
  for (auto revision = before.revision; revision < steps.size(); ++revision) EXPECT_EQ(steps[revision].unlit_fraction, 0);
  EXPECT_GE(steps.back().rays, before.rays);
  EXPECT_GE(steps.back().elapsed_s, before.elapsed_s);
  EXPECT_NEAR(mean_irradiance(edited), mean_irradiance(anew), 0.05 * mean_irradiance(anew));
}

TEST(EditedSolve, GoesOnFromACheckpointOfBeforeTheEdit) {
  const Scene scene = test::coloured_room();
  const BaseMesh mesh(scene);
  const SolveOptions options{.tolerance = 0.03};
  SolutionLog log;
  std::vector<std::byte> state;
  std::stop_source park;
  SolveControl control;
  control.park = park.get_token();
  control.is_checkpoint_due = [&, n = 4]() mutable {
    if (n-- == 0) park.request_stop();
    return false;
  };
  control.save = [&](const SolveControl::Write& write) { state = plain_bytes(write); };
  ASSERT_EQ(solve_as_planned(mesh, Plan(mesh, options), options, log, control).reason, StopReason::parked);
  EXPECT_EQ(edits_of_checkpoint(state), 0u);

  Scene changed = scene;
  changed.materials[0].reflectance = {0.1, 0.1, 0.4};
  const BaseMesh edited = mesh.edited_as(changed);
  std::shared_ptr<LiveSolve> live;
  SolveControl on;
  on.checkpoint = state;
  on.checkpoint_mesh = &mesh;
  on.edits = 7;
  on.live = &live;
  EXPECT_EQ(solve_as_planned(edited, Plan(edited, options), options, log, on).reason, StopReason::tolerance);
  EXPECT_EQ(log.last_step().edits, 7u);
  SolutionLog anew;
  solve(edited, options, anew, {});
  const auto mean = [](const SolutionLog& of) {
    double sum = 0;
    for (const LeafValue& leaf : of.leaves()) sum += leaf.irradiance.mean();
    return sum / static_cast<double>(of.leaves().size());
  };
  EXPECT_NEAR(mean(log), mean(anew), 0.1 * mean(anew));
}

TEST(EditedSolve, IsInterruptedByAnEditAndTellsIt) {
  const BaseMesh mesh(test::coloured_room());
  const SolveOptions options{.tolerance = 1e-3};
  SolutionLog log;
  SolveControl control;
  std::shared_ptr<LiveSolve> live;
  control.live = &live;
  control.is_edited = [&] { return log.head() > 5; };
  EXPECT_EQ(solve_as_planned(mesh, Plan(mesh, options), options, log, control).reason, StopReason::edited);
  ASSERT_TRUE(live);
  EXPECT_EQ(live->edits, 0u);
}

TEST(EditedSolve, HeedsTheNextEditBeforeItEstimates) {
  EditedSolve edited(room_with_two_lamps(), {.tolerance = 0.05});
  const std::uint64_t before = edited.log().head();
  edited.edit_twice([](Scene& scene) { scene.materials.back().emission = 0.9999 * scene.materials.back().emission; });
  EXPECT_EQ(edited.outcome.reason, StopReason::edited);
  EXPECT_EQ(edited.log().head(), before + 1);
  EXPECT_TRUE(edited.last().is_provisional);
}

TEST(EditedSolve, ExchangesNoLightWhileEachEditComesBeforeThatOfTheOneBefore) {
  EditedSolve edited(room_with_two_lamps(), {.tolerance = 0.05});
  const auto recolour = [n = 0](Scene& scene) mutable {
    scene.materials[0].reflectance = ++n % 2 ? Rgb{0.2, 0.5, 0.7} : Rgb{0.7, 0.3, 0.2};
  };
  const auto shots_until_edited = [&](int asks) {
    const std::uint64_t before = edited.last().revision, shots = edited.live()->progress.shots;
    SolveControl control;
    control.is_edited = [&, before, asked = 0]() mutable { return edited.log().head() > before && ++asked >= asks; };
    edited.edit(recolour, {}, std::move(control));
    EXPECT_EQ(edited.outcome.reason, StopReason::edited);
    EXPECT_EQ(edited.last().revision, before + 1);
    EXPECT_TRUE(edited.last().is_provisional);
    return edited.live()->progress.shots - shots;
  };
  const std::uint64_t with_exchange = shots_until_edited(1);
  EXPECT_LT(shots_until_edited(2), with_exchange);
  EXPECT_LT(shots_until_edited(2), with_exchange);
  edited.edit(recolour);
  EXPECT_EQ(edited.outcome.reason, StopReason::tolerance);
}

TEST(EditedSolve, LeavesMoreLightForLaterWhereItsErrorHasItToSpare) {
  constexpr double tolerance = 0.1;
  EditedSolve edited(test::coloured_room(), {.tolerance = tolerance});
  double most_spared = 0;
  for (const double reflectance : {0.2, 0.3, 0.4, 0.5, 0.6, 0.7}) {
    const Step before = edited.last();
    ASSERT_LT(before.estimated_error, 0.8 * tolerance);
    edited.edit([&](Scene& scene) { scene.materials[0].reflectance = {reflectance, 0.5, 0.2}; });
    ASSERT_EQ(edited.outcome.reason, StopReason::tolerance);
    const auto steps = edited.log().steps();
    const auto first = std::find_if(steps.begin() + static_cast<std::ptrdiff_t>(before.revision), steps.end(),
                                    [](const Step& step) { return !step.is_provisional; });
    ASSERT_NE(first, steps.end());
    EXPECT_LE(first->estimated_error, tolerance);
    const double spared = std::sqrt(std::pow(first->estimated_error, 2) - std::pow(steps.back().estimated_error, 2));
    EXPECT_LE(spared, 0.3 * tolerance);
    most_spared = std::max(most_spared, spared);
  }
  EXPECT_GT(most_spared, 0.1 * tolerance);
}

TEST(EditedSolve, HasNoRowsFinerThanLeavesWhereAHiddenObjectIsShownAtTheLimitOfLeaves) {
  Scene scene = test::room_with_lamps_and_sun();
  const auto first = static_cast<std::uint32_t>(scene.faces.size());
  test::add_box(scene, {0.5, 0.5, 0.5}, {1.5, 1.5, 1.5}, false);
  test::add_box(scene, {2.5, 0.5, 0.5}, {3, 1, 1}, false);  // its shadows make leaves finer than rows
  scene.objects = {{.name = "box", .first_face = first, .face_count = 6}};
  Scene without = scene;
  without.objects[0].is_hidden = true;
  EditedSolve edited(scene, {.tolerance = 1e-3, .max_leaves = 1000}, without);
  ASSERT_EQ(edited.outcome.reason, StopReason::max_leaves);
  const auto before = edited.live();
  ASSERT_LT(before->state.forests.rows().leaf_count() + 20, before->state.leaf_count()) << "rows could be split";
  edited.edit([](Scene& of) { of.objects[0].is_hidden = false; });
  ASSERT_EQ(edited.live(), before) << "it should go on";
  const Forests& forests = before->state.forests;
  for (const NodeIndex row : forests.rows().leaves())
    EXPECT_EQ(forests.leaves().id(forests.leaf_node_of(row)), forests.rows().id(row));
  const SolveOptions options{.tolerance = 1e-3, .max_leaves = 1000};
  LiveSolve again(edited.mesh(), Plan(edited.mesh(), options), options, Ranks::alone(), true);
  again.load(plain_bytes([&](PlainWriter& out) { before->save(out); }));
  EXPECT_EQ(again.state.leaf_count(), before->state.leaf_count()) << "of a checkpoint";
}

TEST(EditedSolve, GivesTheTimeLimitAnewToEachEdit) {
  constexpr double limit = 0.3;
  EditedSolve edited(test::coloured_room(), {.tolerance = 1e-4, .time_limit_s = limit});
  EXPECT_EQ(edited.outcome.reason, StopReason::time_limit);
  const double before = edited.outcome.solve_s;
  edited.edit([](Scene& scene) { scene.materials[0].reflectance = {0.2, 0.2, 0.2}; });
  EXPECT_EQ(edited.outcome.reason, StopReason::time_limit);
  EXPECT_GE(edited.outcome.solve_s - before, limit);
}

}  // namespace
}  // namespace alvor
