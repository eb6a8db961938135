#include "radiosity/form_factors/convex_polygon.h"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

namespace alvor {
namespace {

ConvexPolygon regular_polygon(int corners) {
  ConvexPolygon polygon;
  for (int c = 0; c < corners; ++c) {
    const double turn = 2 * std::numbers::pi * c / corners;
    polygon.add({std::cos(turn), std::sin(turn), 0});
  }
  return polygon;
}
double area(const ConvexPolygon& polygon) { return polygon.is_empty() ? 0 : length(area_vector(polygon.corners())); }

TEST(ConvexPolygon, PartsOnBothSidesOfAPlaneMakeTheWhole) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> number(-1, 1);
  for (int n = 0; n < 1000; ++n) {
    const ConvexPolygon whole = regular_polygon(3 + n % 10);
    const Plane plane{{number(random), number(random), number(random)}, number(random)};
    ConvexPolygon above = whole, below;
    move_part_below(above, plane, below);
    EXPECT_TRUE(lies_above(above.corners(), plane, 1e-14));
    EXPECT_TRUE(lies_below(below.corners(), plane, 1e-14));
    EXPECT_NEAR(area(above) + area(below), area(whole), 1e-14);
    EXPECT_NEAR(area(above), area(part_above(whole, plane)), 1e-14);
  }
}

TEST(ConvexPolygon, PlaneThatMissesOrTouchesLeavesItWhole) {
  const ConvexPolygon square = regular_polygon(4);
  for (const double offset : {-1.0, -2.0}) {
    ConvexPolygon above = square, below;
    move_part_below(above, {{1, 0, 0}, offset}, below);
    EXPECT_EQ(area(above), area(square));
    EXPECT_TRUE(below.is_empty());
    ConvexPolygon other = square;
    move_part_below(other, {{-1, 0, 0}, -offset}, below);
    EXPECT_TRUE(other.is_empty());
    EXPECT_EQ(area(below), area(square));
  }
}

TEST(ConvexPolygon, NothingIsCutFromNothing) {
  ConvexPolygon nothing, below = regular_polygon(3);
  move_part_below(nothing, {{1, 0, 0}, 0}, below);
  EXPECT_TRUE(nothing.is_empty());
  EXPECT_TRUE(below.is_empty());
}

}  // namespace
}  // namespace alvor
