#include "radiosity/form_factors/form_factor_matrix.h"

#include "radiosity/form_factors/visible_form_factor.h"
#include "radiosity/rays/hemicube.h"
#include "tests/scenes.h"

#include <gtest/gtest.h>

namespace alvor {
namespace {

/// Returns a box around a box, each face cut into nu x nv quads.
Scene concentric_cubes(double inner_side, int nu, int nv) {
  Scene coarse, scene;
  coarse.materials.push_back(test::grey(0, 0.5));
  test::add_box(coarse, {0, 0, 0}, {1, 1, 1}, true);
  const double low = 0.5 - inner_side / 2, high = 0.5 + inner_side / 2;
  test::add_box(coarse, {low, low, low}, {high, high, high}, false);
  scene.materials = coarse.materials;
  for (const Face& face : coarse.faces) {
    const auto ring = coarse.corners_of(face);
    const auto at = [&](int i, int j) {
      const Vec3 a = coarse.vertices[ring[0]], u = coarse.vertices[ring[1]] - a, v = coarse.vertices[ring[3]] - a;
      return a + (static_cast<double>(i) / nu) * u + (static_cast<double>(j) / nv) * v;
    };
    for (int i = 0; i < nu; ++i)
      for (int j = 0; j < nv; ++j) test::add_polygon(scene, {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
  }
  return scene;
}

struct Matrix {
  explicit Matrix(const Scene& scene, MatrixOptions options = {}, BaseMeshOptions meshing = {})
      : mesh(scene, meshing), faces(scene, mesh), blockers(mesh) {
    form_factor_matrix(faces, blockers, options, [&](std::uint32_t from, std::span<const MatrixEntry> row) {
      EXPECT_EQ(from, rows.size());
      rows.emplace_back(row.begin(), row.end());
    });
  }
  MatrixEntry at(std::uint32_t from, std::uint32_t to) const {
    for (const MatrixEntry& entry : rows[from])
      if (entry.to == to) return entry;
    return {to, 0, 0};
  }
  BaseMesh mesh;
  FacePolygons faces;
  Blockers blockers;
  std::vector<std::vector<MatrixEntry>> rows;
};

TEST(FormFactorMatrix, RowsOfAClosedSceneSumToOneAndNeverMore) {
  const Matrix matrix(concentric_cubes(0.5, 6, 4));
  for (const auto& row : matrix.rows) {
    double sum = 0;
    for (const MatrixEntry& entry : row) {
      EXPECT_GT(entry.value + entry.error_bound, 0);
      sum += entry.value;
    }
    EXPECT_LE(sum, 1);
    EXPECT_NEAR(sum, 1, 6e-6);
  }
}

/// Checks reciprocity between all pairs of faces, within the error bounds of both directions.
void expect_reciprocity(const Scene& scene) {
  const Matrix matrix(scene);
  for (std::uint32_t i = 0; i < matrix.rows.size(); ++i)
    for (const MatrixEntry& entry : matrix.rows[i]) {
      const MatrixEntry back = matrix.at(entry.to, i);
      const double ours = matrix.faces.area(i), theirs = matrix.faces.area(entry.to);
      EXPECT_NEAR(ours * entry.value, theirs * back.value, ours * entry.error_bound + theirs * back.error_bound + 1e-14)
          << i << " to " << entry.to;
    }
}

TEST(FormFactorMatrix, ReciprocityHoldsWithinTheBounds) {
  expect_reciprocity(concentric_cubes(0.5, 4, 3));
  // The scene has faces that cross each other's planes, large faces beside small ones, and tilted faces.
  Scene scene = test::room_with_contacts();
  for (int n = 0; n < 40; ++n) {
    const double x = 0.1 + 0.09 * n, y = 0.3 + 0.06 * (n % 7), z = 0.2 + 0.11 * (n * 17 % 40);
    test::add_polygon(scene, {{x, y, z}, {x + 0.2, y + 0.05, z}, {x + 0.2, y + 0.15, z + 0.2}, {x, y + 0.1, z + 0.2}});
  }
  expect_reciprocity(scene);
}

TEST(FormFactorMatrix, TheSumOverAPairOfTrianglesIsThatOfTheirQuad) {
  Scene quads, triangles;
  quads.materials = triangles.materials = test::coloured_room().materials;
  const Scene room = test::coloured_room();
  for (const Face& face : room.faces) {
    const auto ring = room.corners_of(face);
    std::vector<Vec3> p;
    for (const std::uint32_t v : ring) p.push_back(room.vertices[v]);
    quads.add_polygon(p, face.material);
    triangles.add_polygon(std::vector{p[0], p[1], p[2]}, face.material);
    triangles.add_polygon(std::vector{p[0], p[2], p[3]}, face.material);
  }
  const Matrix whole(quads), halves(triangles, {}, {.join_triangles = false});
  ASSERT_EQ(halves.rows.size(), 2 * whole.rows.size());
  for (std::uint32_t i = 0; i < whole.rows.size(); ++i)
    for (std::uint32_t j = 0; j < whole.rows.size(); ++j) {
      double sum = 0, bound = whole.at(i, j).error_bound;
      for (const std::uint32_t from : {2 * i, 2 * i + 1})
        for (const std::uint32_t to : {2 * j, 2 * j + 1}) {
          const double share = halves.faces.area(from) / whole.faces.area(i);
          sum += share * halves.at(from, to).value;
          bound += share * halves.at(from, to).error_bound;
        }
      EXPECT_NEAR(sum, whole.at(i, j).value, bound + 1e-12) << i << " to " << j;
    }
}

TEST(FormFactorMatrix, BoundsHoldWhereShadowsFall) {
  const Matrix matrix(concentric_cubes(0.5, 5, 3));
  std::vector<const ConvexPolygon*> blockers;
  for (const ConvexPolygon& blocker : matrix.blockers.all()) blockers.push_back(&blocker);
  int shadowed = 0;
  for (std::uint32_t i = 0; i < 30; ++i)
    for (const MatrixEntry& entry : matrix.rows[i]) {
      const auto exact = visible_form_factor(ConvexPolygon(matrix.faces.pieces(i)[0]),
                                             ConvexPolygon(matrix.faces.pieces(entry.to)[0]), blockers, 1e-4);
      EXPECT_LE(std::abs(entry.value - exact.value), entry.error_bound + exact.error_bound) << i << " to " << entry.to;
      shadowed += exact.points > 0;
    }
  EXPECT_GT(shadowed, 100);
}

TEST(FormFactorMatrix, ThreadsDoNotChangeIt) {
  const Scene scene = concentric_cubes(0.5, 3, 2);
  const Matrix one(scene, {.threads = 1}), two(scene, {.threads = 2});
  for (std::size_t i = 0; i < one.rows.size(); ++i) {
    ASSERT_EQ(one.rows[i].size(), two.rows[i].size());
    for (std::size_t n = 0; n < one.rows[i].size(); ++n) EXPECT_EQ(one.rows[i][n].value, two.rows[i][n].value);
  }
}

TEST(Blockers, WallsOfManyQuadsAreOne) {
  const BaseMesh mesh(concentric_cubes(0.5, 7, 5));
  EXPECT_EQ(Blockers(mesh).all().size(), 12u);
}

TEST(Hemicube, DeltaFormFactorsSumToOneAtAnyResolution) {
  for (const HemicubeGrid& grid : {HemicubeGrid::square(2), HemicubeGrid::square(50), HemicubeGrid{4, 2, 2, 1}}) {
    const Hemicube cube(grid);
    EXPECT_EQ(cube.cells().size(), static_cast<std::size_t>(grid.cell_count()));
    double sum = 0;
    for (const Hemicube::Cell& cell : cube.cells()) {
      EXPECT_GT(cell.delta, 0);
      sum += cell.delta;
    }
    EXPECT_NEAR(sum, 1, 1e-12);
  }
}

TEST(FormFactorMatrix, ShadowsAreAsExactInMicrometres) {
  const auto factor = [](double size) {
    const auto square = [size](double half, double y, bool looks_up) {
      const double h = half * size;
      const std::array<Vec3, 4> up{{{-h, y * size, -h}, {-h, y * size, h}, {h, y * size, h}, {h, y * size, -h}}};
      const std::array<Vec3, 4> down{up[3], up[2], up[1], up[0]};
      return ConvexPolygon(looks_up ? up : down);
    };
    const ConvexPolygon floor = square(1, 0, true), ceiling = square(1, 1, false), between = square(0.3, 0.4, true);
    const ConvexPolygon* const blockers[] = {&between};
    return visible_form_factor(floor, ceiling, blockers, 1e-5).value;
  };
  EXPECT_NEAR(factor(0x1p-20), factor(1), 1e-15);
  EXPECT_NEAR(factor(1e-6), factor(1), 1e-9);  // logarithms of lengths round differently
}

TEST(FormFactorMatrix, FacesBackToBackKeepTheirPolygons) {
  Scene scene;
  scene.materials.push_back(test::grey(0, 0.5));
  test::add_polygon(scene, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  test::add_polygon(scene, {{0, 0, 0}, {0, 1, 0}, {1, 1, 0}, {1, 0, 0}});
  const BaseMesh mesh(scene);
  const FacePolygons faces(scene, mesh);
  for (const std::uint32_t face : {0u, 1u}) {
    EXPECT_EQ(faces.pieces(face).size(), 1u);
    EXPECT_EQ(faces.area(face), 1);
  }
}

}  // namespace
}  // namespace alvor
