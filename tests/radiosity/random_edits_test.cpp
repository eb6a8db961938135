// Many random edits of one solve.

#include "meshing/edit/edited_scene.h"
#include "tests/radiosity/edited_solve.h"
#include "tests/radiosity/solve_scenes.h"
#include "tests/random/dice.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace alvor {
namespace {

using test::Change, test::EditedSolve, test::difference_of_parts;

/// Returns a room with a deep window, two lamps of faces, a bulb, a spot, two boxes and a curtain.
Scene room_to_be_edited() {
  Scene scene = test::room_with_deep_window(0.6);
  scene.materials[0].name = "walls";
  scene.materials.push_back({"shine", {20, 18, 15}, {}, false});
  Material curtain = test::grey(0, 0.4);
  curtain.name = "curtain";
  curtain.two_sided = true;
  curtain.diffuse_transmittance = {0.3, 0.3, 0.2};
  scene.materials.push_back(curtain);
  const auto add = [&](const char* name, auto&& add_faces) {
    const auto first = static_cast<std::uint32_t>(scene.faces.size());
    add_faces();
    scene.objects.push_back(
        {.name = name, .first_face = first, .face_count = static_cast<std::uint32_t>(scene.faces.size()) - first});
  };
  add("box", [&] { test::add_box(scene, {1, 0.2, 1.5}, {1.8, 1, 2.3}, false); });
  add("block", [&] { test::add_box(scene, {2.4, 0.2, 2}, {3, 1.4, 2.5}, false); });
  add("lamp", [&] { test::add_polygon(scene, {{1.5, 2.8, 2}, {2.5, 2.8, 2}, {2.5, 2.8, 3}, {1.5, 2.8, 3}}, 1); });
  add("panel", [&] { test::add_polygon(scene, {{0.5, 2.7, 4}, {0.9, 2.7, 4}, {0.9, 2.7, 4.4}, {0.5, 2.7, 4.4}}, 1); });
  add("blind", [&] { test::add_polygon(scene, {{3.2, 0.5, 1}, {3.2, 2.2, 1}, {3.2, 2.2, 2}, {3.2, 0.5, 2}}, 2); });
  Light bulb{"bulb", LightKind::point, {4, 4, 3}, {2, 2, 4}};
  bulb.radius = 0.05;
  Light spot{"spot", LightKind::spot, {9, 9, 9}, {3, 2.6, 3.5}};
  spot.direction = {0, -1, 0};
  spot.radius = 0.04;
  spot.inner_cone = 0.3, spot.outer_cone = 0.6;
  scene.lights = {bulb, spot};
  return scene;
}

Rgb any_colour(test::Dice& dice, double most) {
  const double r = dice.between(0, most), g = dice.between(0, most), b = dice.between(0, most);
  return {r, g, b};
}

Vec3 any_place(test::Dice& dice, Vec3 low, Vec3 high) {
  const double x = dice.between(low.x, high.x), y = dice.between(low.y, high.y), z = dice.between(low.z, high.z);
  return {x, y, z};
}

Daylight any_daylight(test::Dice& dice) {
  Daylight any;
  any.sky = dice.one_of({Daylight::Sky::none, Daylight::Sky::uniform, Daylight::Sky::overcast});
  if (any.sky == Daylight::Sky::none || dice.happens(0.5)) {
    const double azimuth = dice.between(0, 60);
    any.sun = SunPosition{.azimuth = azimuth, .elevation = dice.between(5, 60)};
    if (dice.happens(0.5)) any.sun_irradiance = dice.between(0, 50);
  }
  if (any.sky != Daylight::Sky::none) any.sky_irradiance = dice.between(1, 20);
  if (dice.happens(0.5)) any.ground_reflectance = dice.between(0, 0.5);
  return any;
}

/// Returns an edit of any part of room_to_be_edited().
SceneEdit any_edit(test::Dice& dice) {
  const char* const solid = dice.one_of({"box", "block"});
  switch (dice.below(17)) {
    case 0: return ObjectEdit{.name = solid, .move = any_place(dice, {-0.6, 0, -1}, {0.6, 0.5, 2})};
    case 1: return ObjectEdit{.name = solid, .turn = dice.between(-180, 180)};
    case 2: return ObjectEdit{.name = dice.one_of({"box", "block", "blind"}), .hidden = dice.happens(0.5)};
    case 3: return ObjectEdit{.name = "lamp", .move = any_place(dice, {-1, -0.5, -1}, {1, 0, 1})};
    case 4: return MaterialEdit{.name = "walls", .reflectance = any_colour(dice, 0.8)};
    case 5:
      return MaterialEdit{
          .name = "curtain", .reflectance = any_colour(dice, 0.5), .diffuse_transmittance = any_colour(dice, 0.45)};
    case 6: return MaterialEdit{.name = "shine", .emission = Rgb{1, 1, 1} + any_colour(dice, 20)};
    case 7: return ObjectEdit{.name = dice.one_of({"lamp", "panel"}), .dim = dice.happens(0.75) ? dice.between(0.1, 2) : 0};
    case 8: return LightEdit{.name = dice.one_of({"bulb", "spot"}), .dim = dice.happens(0.75) ? dice.between(0.1, 3) : 0};
    case 9: return LightEdit{.name = "bulb", .position = any_place(dice, {0.5, 1.6, 3}, {3.5, 2.5, 4.5})};
    case 10: return MediumEdit{dice.happens(0.5) ? any_colour(dice, 0.2) : Rgb{}};
    case 11: return LightEdit{.name = "bulb", .intensity = any_colour(dice, 8)};
    case 12: return LightEdit{.name = "spot", .direction = any_place(dice, {-1, -1, -1}, {1, -0.5, 1})};
    case 13: return LightEdit{.name = "spot", .cone = ConeAngles{dice.between(0.1, 0.4), dice.between(0.4, 1.2)}};
    case 14:
      return ObjectEdit{.name = "box",
                        .turn = dice.between(-40, 40),
                        .turn_axis = Vec3{1, 0, dice.between(-1, 1)},
                        .scale = dice.between(0.7, 1.3)};
    case 15: return MaterialEdit{.name = "curtain", .regular_transmittance = any_colour(dice, 0.05)};
    default: return DaylightEdit{any_daylight(dice)};
  }
}

/// Steps of edits of room_to_be_edited(), as a server would keep them: some of several edits, some taken back or made again.
class AnySteps {
 public:
  explicit AnySteps(std::uint64_t seed) : dice_(seed) {}

  /// Makes a step and returns the edits that hold then.
  std::vector<SceneEdit> next() {
    const EditStep before = steps_.empty() ? EditStep{} : steps_.back();
    if (const auto holds = dice_.happens(0.2) ? try_step({EditStep::Kind::undo}) : std::nullopt) return *holds;
    const bool makes_again = before.kind == EditStep::Kind::undo && dice_.happens(0.5);
    if (const auto holds = makes_again ? try_step({EditStep::Kind::redo}) : std::nullopt) return *holds;
    EditStep step;
    if (copies_ < 4 && dice_.happens(0.05)) {
      const std::string name = "block " + std::to_string(++copies_);
      step.edits = {ObjectCopy{name, "block"}, ObjectEdit{.name = name, .move = any_place(dice_, {-1.5, 0, -1}, {0.5, 1, 2})}};
    } else {
      for (int n = dice_.happens(0.2) ? 3 : 1; n > 0; --n) step.edits.push_back(any_edit(dice_));
    }
    return try_step(step).value();
  }
  /// Takes back all steps and returns the edits that hold then: copies that were taken back.
  std::vector<SceneEdit> take_all_back() {
    std::vector<SceneEdit> holds;
    while (const auto fewer = try_step({EditStep::Kind::undo})) holds = *fewer;
    return holds;
  }
  bool happens(double probability) { return dice_.happens(probability); }

 private:
  std::optional<std::vector<SceneEdit>> try_step(EditStep step) {
    steps_.push_back(std::move(step));
    const auto holds = edits_that_hold(steps_);
    if (!holds) steps_.pop_back();
    return holds;
  }

  test::Dice dice_;
  std::vector<EditStep> steps_;
  int copies_ = 0;
};

// $ALVOR_RANDOM_EDITS is the number of steps (60).
TEST(RandomEdits, LeaveASolveWithinWhatItTellsOfANewOne) {
  const char* const wanted = std::getenv("ALVOR_RANDOM_EDITS");
  const int count = wanted ? std::atoi(wanted) : 60;
  const SolveOptions options{.tolerance = 0.1, .max_leaves = 6000};
  constexpr int cells = 8;
  const Scene submitted = room_to_be_edited();
  AnySteps steps(5);
  EditedSolve solve(submitted, options);
  int compared = 0, within = 0;
  for (int n = 1; n <= count; ++n) {
    const std::vector<SceneEdit> edits = steps.next();
    const auto fault = fault_in(edits, submitted);
    ASSERT_FALSE(fault) << fault->field << ' ' << fault->reason;
    const Change change = [&](Scene& scene) { scene = edited_scene(submitted, edits); };
    if (steps.happens(0.1)) solve.edit_from_checkpoint(change);
    else solve.edit(change);
    ASSERT_EQ(solve.last().edits, static_cast<std::uint64_t>(n));
    if (n % 10 != 0) continue;
    const EditedSolve anew(submitted, options, solve.scene());
    const double told = std::hypot(solve.last().estimated_error, anew.last().estimated_error);
    const bool is_as_good = solve.last().estimated_error < std::max(options.tolerance, 1.5 * anew.last().estimated_error);
    within += difference_of_parts(solve, anew, cells) < told && is_as_good;
    ++compared;
  }
  EXPECT_GT(compared, 0);
  EXPECT_GE(within, 0.9 * compared);
  const std::vector<SceneEdit> none = steps.take_all_back();
  solve.edit([&](Scene& scene) { scene = edited_scene(submitted, none); });
  const EditedSolve first(submitted, options, solve.scene());
  EXPECT_LT(difference_of_parts(solve, first, cells), solve.last().estimated_error + first.last().estimated_error);
}

}  // namespace
}  // namespace alvor
