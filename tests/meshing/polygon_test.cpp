#include "meshing/polygon.h"

#include "meshing/ear_clipping.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace alvor {
namespace {

double area_of_pieces(std::span<const Vec3> polygon) {
  double area = 0;
  for (const Piece& piece : pieces_of(polygon)) {
    std::vector<Vec3> corners;
    for (const std::uint32_t corner : piece)
      if (corner != no_corner) corners.push_back(polygon[corner]);
    area += 0.5 * length(double_area_vector(corners));
  }
  return area;
}

TEST(Polygon, PlanarConvexQuadStaysWhole) {
  const Vec3 quad[] = {{0, 0, 0}, {2, 0, 0}, {3, 1, 0}, {0, 1, 0}};
  EXPECT_EQ(pieces_of(quad), (std::vector<Piece>{{0, 1, 2, 3}}));
}

TEST(Polygon, TwistedQuadIsTheFanAboutItsFirstCorner) {
  const Vec3 quad[] = {{0, 0, 0}, {1, 0, 0.1}, {1, 1, 0}, {0, 1, 0.1}};
  EXPECT_EQ(pieces_of(quad), (std::vector<Piece>{{0, 1, 2, no_corner}, {0, 2, 3, no_corner}}));
}

TEST(Polygon, QuadIsCutWhereItIsBentByMoreThanRaysStartAboveIt) {
  const auto bent_by = [](double height) {
    const Vec3 quad[] = {{0, 0, 0}, {1, 0, 0}, {1, 1, height}, {0, 1, 0}};
    return pieces_of(quad).size();
  };
  EXPECT_EQ(bent_by(1e-6), 1u);
  EXPECT_EQ(bent_by(2e-5), 2u);
}

TEST(Polygon, ConcavePolygonsKeepTheirArea) {
  const Vec3 dart[] = {{0, 0, 0}, {2, 0, 0}, {0.5, 0.5, 0}, {0, 2, 0}};
  EXPECT_NEAR(area_of_pieces(dart), 1, 1e-12);
  const Vec3 l_shape[] = {{0, 0, 5}, {3, 0, 5}, {3, 1, 5}, {1, 1, 5}, {1, 3, 5}, {0, 3, 5}};
  EXPECT_EQ(pieces_of(l_shape).size(), 4u);
  EXPECT_NEAR(area_of_pieces(l_shape), 5, 1e-12);
}

TEST(Polygon, StraightCornersAreNoObstacle) {
  const Vec3 polygon[] = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}};
  EXPECT_NEAR(area_of_pieces(polygon), 4, 1e-12);
}

/// Returns a comb: `teeth` long thin teeth along x, two corners each, over a spine.
std::vector<Vec3> comb(int teeth) {
  std::vector<Vec3> polygon{{0, 0, 0}, {double(teeth), 0, 0}};
  for (int n = teeth - 1; n >= 0; --n) {
    polygon.push_back({n + 0.9, 10, 0});
    polygon.push_back({n + 0.5, 1, 0});
  }
  return polygon;
}

TEST(Polygon, TrianglesOfRandomStarsNeitherOverlapNorLeaveGaps) {
  std::mt19937_64 dice(7);
  std::uniform_real_distribution<double> radius(0.1, 1);
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<Vec3> star;
    const int corners = 5 + trial;
    for (int n = 0; n < corners; ++n) {
      const double angle = 2 * std::numbers::pi * n / corners, r = radius(dice);
      star.push_back({r * std::cos(angle), 0.3, r * std::sin(angle)});
    }
    const Vec3 area = double_area_vector(star);
    const auto triangles = clip_ears(star, normalized(area));
    ASSERT_EQ(triangles.size(), star.size() - 2);
    double sum = 0;
    for (const auto& [a, b, c] : triangles) {
      const double part = dot(cross(star[b] - star[a], star[c] - star[b]), normalized(area));
      EXPECT_GE(part, -1e-15) << "no triangle is turned over";
      sum += part;
    }
    EXPECT_NEAR(sum, length(area), 1e-12 * length(area));
  }
}

// Takes hours if all corners are tested for each ear.
TEST(Polygon, OneOfAHundredThousandCornersIsCut) {
  const auto polygon = comb(50'000);
  EXPECT_NEAR(area_of_pieces(polygon), 0.5 * length(double_area_vector(polygon)), 1e-6);
  std::vector<Vec3> nearly_straight{{1, 1, 0}, {0, 1, 0}};
  for (int n = 0; n < 100'000; ++n) nearly_straight.push_back({n / 99'999.0, 1e-9 * (n % 2), 0});
  EXPECT_NEAR(area_of_pieces(nearly_straight), 1, 1e-6);
}

}  // namespace
}  // namespace alvor
