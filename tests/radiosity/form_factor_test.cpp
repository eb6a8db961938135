#include "radiosity/form_factors/form_factor.h"

#include <gtest/gtest.h>

#include <array>
#include <numbers>
#include <vector>

namespace alvor {
namespace {

constexpr double pi = std::numbers::pi;

/// Returns a rectangle a x b parallel to the receiver at height c, one corner above the point, its front down (Howell, catalogue
/// B-3).
double parallel_rectangle(double a, double b, double c) {
  const double x = a / c, y = b / c, p = std::sqrt(1 + x * x), q = std::sqrt(1 + y * y);
  return (x / p * std::atan(y / p) + y / q * std::atan(x / q)) / (2 * pi);
}

TEST(FormFactor, ParallelRectangleMatchesTheClosedForm) {
  for (const auto& [a, b, c] : {std::array{1.0, 1.0, 1.0}, {2.0, 0.5, 0.1}, {1e-3, 1e-3, 10.0}, {1e3, 1e3, 1.0}}) {
    const Vec3 front_down[] = {{0, 0, c}, {0, b, c}, {a, b, c}, {a, 0, c}};
    const double expected = parallel_rectangle(a, b, c);
    EXPECT_NEAR(point_to_polygon({0, 0, 0}, {0, 0, 1}, front_down), expected, 1e-9 * expected + 1e-15);
  }
}

// A regular polygon over the point: by symmetry each edge brings the same. Its edges are seen under angles from 1e-7
// to 2.1 radians (120 degrees).
TEST(FormFactor, RegularPolygonOfAnyNumberOfCornersMatchesTheClosedForm) {
  for (const double height : {1e-6, 0.1, 1.0, 1e6})
    for (int count = 3; count <= 64; ++count) {
      std::vector<Vec3> polygon;
      for (int c = 0; c < count; ++c) polygon.push_back({std::sin(2 * pi * c / count), std::cos(2 * pi * c / count), height});
      const double half_edge = std::sin(pi / count), apothem = std::cos(pi / count), distance = std::hypot(apothem, height);
      const double expected = count / pi * std::atan(half_edge / distance) * apothem / distance;
      EXPECT_NEAR(point_to_polygon_above({0, 0, 0}, {0, 0, 1}, polygon), expected, 1e-9 * expected)
          << count << " corners at height " << height;
      EXPECT_NEAR(point_to_polygon_above({0, 0, 0}, {0, 0, 1}, polygon), expected, 1e-14);
    }
}

// A wall that stands on the receiver's plane, close to the point, so that its lower edge is seen under nearly 180 degrees. It is
// two perpendicular rectangles (Howell, catalogue B-4), each of height and width 1.
TEST(FormFactor, WallBesideThePointMatchesTheClosedForm) {
  for (const double away : {1e-1, 1e-2, 1e-4, 1e-6, 1e-8}) {
    const Vec3 wall[] = {{-1, away, 0}, {1, away, 0}, {1, away, 1}, {-1, away, 1}};
    const double slant = std::hypot(away, 1);
    const double expected = (std::atan(1 / away) - away / slant * std::atan(1 / slant)) / pi;
    EXPECT_NEAR(point_to_polygon_above({0, 0, 0}, {0, 0, 1}, wall), expected, 1e-14) << away << " m away";
  }
}

TEST(FormFactor, BackOfThePolygonGivesNothing) {
  const Vec3 front_up[] = {{0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  EXPECT_EQ(point_to_polygon({0, 0, 0}, {0, 0, 1}, front_up), 0);
}

TEST(FormFactor, PartBelowTheHorizonIsCutOff) {
  const Vec3 wall[] = {{1, -1, -5}, {1, -1, 2}, {1, 1, 2}, {1, 1, -5}};
  const Vec3 upper[] = {{1, -1, 0}, {1, -1, 2}, {1, 1, 2}, {1, 1, 0}};
  const double whole = point_to_polygon({0, 0, 0}, {0, 0, 1}, wall);
  EXPECT_GT(whole, 0.01);
  EXPECT_NEAR(whole, point_to_polygon({0, 0, 0}, {0, 0, 1}, upper), 1e-12);
}

TEST(FormFactor, FacesOfAClosedRoomSumToOne) {
  const Vec3 point{0.3, 0.2, 0}, normal{0, 0, 1};
  const std::vector<std::vector<Vec3>> room{{{0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}},
                                            {{0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}},
                                            {{1, 0, 0}, {1, 0, 1}, {1, 1, 1}, {1, 1, 0}},
                                            {{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0}},
                                            {{0, 1, 0}, {1, 1, 0}, {1, 1, 1}, {0, 1, 1}}};
  double sum = 0;
  for (const auto& face : room) sum += point_to_polygon(point, normal, face);
  EXPECT_NEAR(sum, 1, 1e-12);
}

// The quad's corners lie above and below the horizon by turns, as rounding leaves them. Cutting it leaves six corners.
TEST(FormFactor, QuadSeenEdgeOnGivesNothing) {
  constexpr double h = 1e-17;
  const Vec3 edge_on[] = {{1, -1, h}, {2, -1, -h}, {2, 1, h}, {1, 1, -h}};
  EXPECT_NEAR(point_to_polygon({0, 0, 0}, {0, 0, 1}, edge_on), 0, 10 * h);
}

}  // namespace
}  // namespace alvor
