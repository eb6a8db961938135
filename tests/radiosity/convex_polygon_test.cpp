#include "radiosity/form_factors/convex_polygon.h"

#include "radiosity/form_factors/shadow_cone.h"

#include <gtest/gtest.h>

#include <numbers>
#include <random>
#include <vector>

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

// The part of a square inside the shadow of a blocker and the parts outside make the whole square. The blockers hide all of it, a
// part or nothing.
TEST(ShadowCone, PartInsideAndPartsOutsideMakeTheWhole) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> number(-1, 1);
  const ConvexPolygon square = regular_polygon(4);
  int partly = 0;
  for (int n = 0; n < 1000; ++n) {
    const Vec3 middle{number(random), number(random), -1 + 0.5 * number(random)};
    const Vec3 s{number(random), number(random), 0.4 * number(random)}, t{number(random), number(random), 0.4 * number(random)};
    const Vec3 blocker[] = {middle - s, middle - t, middle + s, middle + t};
    const ShadowCone shadow({0.1 * number(random), 0.1 * number(random), -3}, blocker);
    std::vector<ConvexPolygon> outside;
    shadow.cut_from(square, outside);
    double sum = 0;
    for (const ConvexPolygon& part : outside) sum += area(part);
    const double inside = area(shadow.part_inside(square));
    EXPECT_NEAR(sum + inside, area(square), 1e-12);
    partly += inside > 0.01 && sum > 0.01;
  }
  EXPECT_GT(partly, 100);
}

TEST(ConvexPolygon, NothingIsCutFromNothing) {
  ConvexPolygon nothing, below = regular_polygon(3);
  move_part_below(nothing, {{1, 0, 0}, 0}, below);
  EXPECT_TRUE(nothing.is_empty());
  EXPECT_TRUE(below.is_empty());
}

}  // namespace
}  // namespace alvor
