#include "meshing/polygon.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace alvor
