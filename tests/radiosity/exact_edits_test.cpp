// Edits of materials and lights where nothing is random: rows are exact form factors, and no leaf is split.

#include "tests/radiosity/edited_solve.h"
#include "tests/radiosity/solve_scenes.h"
#include "tests/random/dice.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace alvor {
namespace {

using test::Change, test::EditedSolve;

constexpr double tolerance = 1e-9;
const SolveOptions exact{.tolerance = tolerance, .max_depth = 0, .form_factors = FormFactorMethod::analytic};

/// Returns an empty room with two lamps of different materials, 1 and 2.
Scene room_with_two_lamps() {
  Scene scene;
  scene.materials = {{"walls", {}, {0.8, 0.5, 0.2}, false}, test::grey(30, 0), test::grey(20, 0)};
  test::add_box(scene, {0, 0, 0}, {4, 3, 5}, true);
  test::add_polygon(scene, {{1.5, 2.9, 2}, {2.5, 2.9, 2}, {2.5, 2.9, 3}, {1.5, 2.9, 3}}, 1);
  test::add_polygon(scene, {{0.3, 2.9, 0.5}, {0.6, 2.9, 0.5}, {0.6, 2.9, 1}, {0.3, 2.9, 1}}, 2);
  return scene;
}

/// Returns the irradiance of all leaves as the solve has it, W/m2: published values are floats.
std::vector<Rgb> irradiance(EditedSolve& solve) {
  const SolveState& state = solve.live()->state;
  std::vector<Rgb> values;
  for (const NodeIndex leaf : state.forests.all_leaves())
    values.push_back(state.in_watts_per_m2(state.direct[leaf].irradiance + state.indirect(leaf, state.forests.row_of(leaf))));
  return values;
}

/// Returns the largest difference in any band, as a share of the mean of `of`.
double largest_difference(const std::vector<Rgb>& a, const std::vector<Rgb>& of) {
  EXPECT_EQ(a.size(), of.size());
  double most = 0, sum = 0;
  for (std::size_t n = 0; n < std::min(a.size(), of.size()); ++n) {
    most = std::max(most, absolute(a[n] - of[n]).max());
    sum += of[n].mean();
  }
  return most * static_cast<double>(of.size()) / sum;
}

struct Case {
  std::string name;
  Change change;
};
void PrintTo(const Case& one, std::ostream* out) { *out << one.name; }

class ExactEdit : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(Cases, ExactEdit,
                         testing::Values(Case{"Reflectance",
                                              [](Scene& s) {
                                                s.materials[0].reflectance = {0.1, 0.7, 0.3};
                                              }},
                                         Case{"OneLampDimmed",
                                              [](Scene& s) { s.materials.back().emission = 0.37 * s.materials.back().emission; }},
                                         Case{"OneLampOff", [](Scene& s) { s.materials.back().emission = {}; }},
                                         Case{"OneLampInAnotherColour",
                                              [](Scene& s) {
                                                s.materials.back().emission = {1, 15, 28};
                                              }},
                                         Case{"AllLampsDimmed",
                                              [](Scene& s) {
                                                for (Material& material : s.materials)
                                                  material.emission = 0.3 * material.emission;
                                              }},
                                         Case{"LampAndReflectance",
                                              [](Scene& s) {
                                                s.materials[1].emission = 2 * s.materials[1].emission;
                                                s.materials[0].reflectance = {0.6, 0.5, 0.4};
                                              }}),
                         [](const auto& one) { return one.param.name; });

TEST_P(ExactEdit, EqualsANewSolve) {
  EditedSolve edited(room_with_two_lamps(), exact);
  edited.edit(GetParam().change);
  EditedSolve anew(edited.scene(), exact);
  EXPECT_LT(largest_difference(irradiance(edited), irradiance(anew)), tolerance);
}

TEST_P(ExactEdit, TakenBackLeadsToTheFirstState) {
  const Scene first = room_with_two_lamps();
  EditedSolve edited(first, exact);
  const auto before = irradiance(edited);
  edited.edit(GetParam().change);
  edited.edit([&](Scene& scene) { scene = first; });
  EXPECT_LT(largest_difference(irradiance(edited), before), tolerance);
}

TEST(ExactEdits, ManyLeadToWhatANewSolveFindsAndTakenBackToTheFirstState) {
  const Scene first = room_with_two_lamps();
  EditedSolve edited(first, exact);
  const auto before = irradiance(edited);
  test::Dice dice(3);
  const auto any_colour = [&](double most) {
    const double r = dice.between(0, most), g = dice.between(0, most), b = dice.between(0, most);
    return Rgb{r, g, b};
  };
  for (int n = 0; n < 40; ++n)
    edited.edit([&](Scene& scene) {
      if (dice.happens(0.5)) scene.materials[0].reflectance = any_colour(0.9);
      else (dice.happens(0.5) ? scene.materials[1] : scene.materials.back()).emission = any_colour(30);
    });
  EditedSolve anew(edited.scene(), exact);
  EXPECT_LT(largest_difference(irradiance(edited), irradiance(anew)), tolerance);
  edited.edit([&](Scene& scene) { scene = first; });
  EXPECT_LT(largest_difference(irradiance(edited), before), tolerance);
}

}  // namespace
}  // namespace alvor
