#include "radiosity/solve/compare.h"

#include "tests/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace alvor {
namespace {

Comparison compared(const Scene& scene, const CompareOptions& options) {
  return compare_strategies(BaseMesh(scene), options, {});
}

const StrategyCourse& course_of(Strategy strategy, const Comparison& comparison) {
  return *std::ranges::find(comparison.courses, strategy, &StrategyCourse::strategy);
}

TEST(Compare, AllStrategiesGoFromTheSameStartToTheSameEnd) {
  const Comparison comparison = compared(test::coloured_room(), {.tolerance = 0.1});
  ASSERT_EQ(comparison.courses.size(), 5u);
  EXPECT_GT(comparison.patches, 100u);
  for (const StrategyCourse& course : comparison.courses) {
    SCOPED_TRACE(text(course.strategy));
    EXPECT_EQ(course.curve.front().steps, 0u);
    const double start = comparison.courses.front().curve.front().error;
    EXPECT_EQ(course.curve.front().error == start, !shows_ambient(course.strategy));
    EXPECT_LE(course.curve.back().error, 1e-6);
    EXPECT_TRUE(std::ranges::is_sorted(course.curve, {}, &ErrorSample::steps));
    EXPECT_TRUE(std::ranges::is_sorted(course.curve, {}, &ErrorSample::cpu_s));
  }
}

TEST(Compare, MoreKnowledgeIsCloserAfterTheSameSteps) {
  const Comparison comparison = compared(test::coloured_room(), {.tolerance = 0.1, .steps = 50});
  const auto error = [&](Strategy strategy) { return course_of(strategy, comparison).error; };
  EXPECT_LT(error(Strategy::sorted_ambient), error(Strategy::overshoot));
  EXPECT_LT(error(Strategy::sorted_ambient), error(Strategy::sorted));
  EXPECT_LT(error(Strategy::sorted), error(Strategy::shoot));
  EXPECT_LT(error(Strategy::sorted), error(Strategy::gather));
  EXPECT_LT(steps_to(1e-6, course_of(Strategy::overshoot, comparison)), steps_to(1e-6, course_of(Strategy::sorted, comparison)));
}

TEST(Compare, PicturesAreOfTheSameLeavesAfterTheStepsAskedFor) {
  const Comparison comparison = compared(test::coloured_room(), {.tolerance = 0.1, .steps = 37});
  ASSERT_FALSE(comparison.converged.empty());
  EXPECT_EQ(comparison.leaves, comparison.converged.size());
  EXPECT_TRUE(std::ranges::is_sorted(comparison.converged, {}, &LeafValue::patch));
  for (const StrategyCourse& course : comparison.courses) {
    SCOPED_TRACE(text(course.strategy));
    EXPECT_TRUE(std::ranges::equal(course.leaves, comparison.converged, {}, &LeafValue::patch, &LeafValue::patch));
    EXPECT_NE(course.leaves, comparison.converged);
    EXPECT_EQ(course.ambient_irradiance.is_zero(), course.strategy != Strategy::sorted_ambient);
    const auto looked = std::ranges::find(course.curve, 37u, &ErrorSample::steps);
    ASSERT_NE(looked, course.curve.end());
    EXPECT_EQ(looked->error, course.error);
  }
}

TEST(Compare, NothingIsComparedInTheDark) {
  Scene scene;
  scene.materials = {test::grey(0, 0.5)};
  test::add_box(scene, {0, 0, 0}, {1, 1, 1}, true);
  EXPECT_TRUE(compared(scene, {}).courses.empty());
}

TEST(Compare, RoomThatReflectsNothingIsDoneAtTheStart) {
  Scene scene;
  scene.materials = {test::grey(0, 0), test::grey(1, 0)};
  test::add_box(scene, {0, 0, 0}, {1, 1, 1}, true, {0, 1, 0, 0, 0, 0});
  for (const StrategyCourse& course : compared(scene, {.tolerance = 0.1, .steps = 5}).courses) EXPECT_EQ(course.error, 0);
}

TEST(Compare, StopRequestEndsItEarly) {
  std::stop_source stop;
  stop.request_stop();
  EXPECT_TRUE(compare_strategies(BaseMesh(test::coloured_room()), {}, stop.get_token()).courses.empty());
}

}  // namespace
}  // namespace alvor
