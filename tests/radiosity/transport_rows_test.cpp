#include "radiosity/rays/transport_rows.h"

#include "meshing/patch_forest.h"
#include "radiosity/form_factors/form_factor.h"
#include "tests/scenes.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

namespace alvor {
namespace {

struct Traced {
  std::vector<PatchId> patches;
  std::vector<TransportRow> rows;
};

Traced trace(const BaseMesh& mesh, int splits, std::uint64_t seed = 1) {
  PatchForest forest(mesh);
  std::vector<NodeIndex> split;
  for (int n = 0; n < splits; ++n) forest.split(forest.leaves()[0], {}, split);
  std::vector<PatchShape> shapes;
  Traced traced;
  for (const NodeIndex leaf : forest.leaves()) {
    shapes.push_back(forest.shape(leaf));
    traced.patches.push_back(forest.id(leaf));
  }
  const LocalScene scene(mesh);
  RayBudget budget([] { return false; });
  const std::vector<RowSize> sizes(shapes.size(), RowSize::whole);
  traced.rows = trace_rows(scene, DirectionSets(seed), shapes, traced.patches, sizes, seed, budget);
  EXPECT_GE(budget.rays(), traced.patches.size() * rays_per_row);
  return traced;
}

TEST(TransportRows, RowsOfAClosedRoomSumToOne) {
  Scene scene = test::furnace(1, 0.5);
  test::add_box(scene, {1, 0.5, 1}, {2, 1, 2}, false);
  for (const TransportRow& row : trace(BaseMesh(scene), 100).rows)
    EXPECT_EQ(row.hits.size(), row.ray_count()) << "every ray must end on a front";
}

TEST(TransportRows, HitsFollowTheFormFactorsOfTheFaces) {
  const BaseMesh mesh(test::furnace(1, 0.5));
  const Traced traced = trace(mesh, 0);
  std::map<std::uint32_t, int> hits;
  for (const PatchId& hit : traced.rows[0].hits) ++hits[hit.root_face()];
  // Rows sample the floor uniformly, so they are compared with the exact mean over a fine grid of its points.
  std::map<std::uint32_t, double> exact;
  constexpr int n = 20;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (std::uint32_t face = 1; face < 6; ++face)
        exact[face] += point_to_polygon(mesh.roots()[0].at((i + 0.5) / n, (j + 0.5) / n), mesh.roots()[0].normal,
                                        std::span(mesh.roots()[face].corners)) /
                       (n * n);
  for (const auto& [face, factor] : exact) {
    const double standard_error = std::sqrt(factor * (1 - factor) / rays_per_row);  // stratified rays err less
    EXPECT_NEAR(double(hits[face]) / rays_per_row, factor, 3 * standard_error) << "face " << face;
  }
  EXPECT_FALSE(hits.contains(0));
}

/// Traces the row of the floor of a closed room by a guide that sends two thirds of the rays to a part of the hemisphere.
TransportRow guided_row(const BaseMesh& mesh, std::uint64_t seed) {
  DirectionGuide::Codes codes;
  for (std::size_t c = 0; c < DirectionGuide::cells; ++c) codes[c] = c / DirectionGuide::side < 4 ? 240 : 40;
  const DirectionGuide guide(codes);
  const DirectionGuide* const guides[]{&guide};
  const PatchId patch = PatchId::root(0);
  const PatchShape shape = shape_of(mesh, patch);
  const RowSize size = RowSize::whole;
  RayBudget budget([] { return false; });
  return trace_rows(LocalScene(mesh), DirectionSets(seed), {&shape, 1}, {&patch, 1}, {&size, 1}, seed, budget, {}, guides)[0];
}

TEST(TransportRows, GuidedRowsOfAClosedRoomSumToOne) {
  const BaseMesh mesh(test::furnace(1, 0.5));
  for (const std::uint64_t seed : {1, 2, 3}) {
    const TransportRow row = guided_row(mesh, seed);
    ASSERT_EQ(row.hit_weight.size(), row.hits.size());
    EXPECT_TRUE(row.is_closed);
    EXPECT_NEAR(row.stored_weight().g, rays_per_row, 1e-3);
  }
}

TEST(TransportRows, GuidedRowsAgreeWithOthersOverManySeeds) {
  const BaseMesh mesh(test::furnace(1, 0.5));
  constexpr int seeds = 200;
  std::map<std::uint32_t, double> guided, squares, unguided;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    const TransportRow row = guided_row(mesh, seed);
    std::map<std::uint32_t, double> seen;
    for (std::size_t h = 0; h < row.hits.size(); ++h) seen[row.hits[h].root_face()] += double(row.hit_weight[h].g) / rays_per_row;
    for (const auto& [face, factor] : seen) guided[face] += factor / seeds, squares[face] += factor * factor / seeds;
    const Traced cosine = trace(mesh, 0, seed);
    for (const PatchId hit : cosine.rows[0].hits) unguided[hit.root_face()] += 1.0 / (seeds * rays_per_row);
  }
  EXPECT_EQ(guided.size(), 5u);
  for (const auto& [face, factor] : guided) {
    // The unguided mean errs less: its rays are stratified better.
    const double standard_error = std::sqrt(2 * std::max(0.0, squares[face] - factor * factor) / seeds);
    EXPECT_NEAR(factor, unguided[face], 3.5 * standard_error) << "face " << face;
  }
}

TEST(TransportRows, GuidedAndOtherRoundsOfRaysAddUp) {
  const BaseMesh mesh(test::furnace(1, 0.5));
  for (const bool is_guided_first : {false, true}) {
    TransportRow row = is_guided_first ? guided_row(mesh, 1) : trace(mesh, 0).rows[0];
    row.append(is_guided_first ? trace(mesh, 0).rows[0] : guided_row(mesh, 1));
    ASSERT_EQ(row.hit_weight.size(), row.hits.size());
    EXPECT_NEAR(row.stored_weight().g, 2 * rays_per_row, 1e-3);
  }
}

TEST(TransportRows, SameSeedGivesTheSameRowsAndAnotherSeedOthers) {
  const BaseMesh mesh(test::furnace(1, 0.5));
  const Traced first = trace(mesh, 20, 5), again = trace(mesh, 20, 5), other = trace(mesh, 20, 6);
  bool differ = false;
  for (std::size_t r = 0; r < first.rows.size(); ++r) {
    EXPECT_EQ(first.rows[r].hits, again.rows[r].hits);
    differ |= first.rows[r].hits != other.rows[r].hits;
  }
  EXPECT_TRUE(differ);
}

TEST(TransportRows, OriginsUnderASolidAreHidden) {
  Scene scene = test::furnace(1, 0.5);
  test::add_box(scene, {0, 0, 0}, {1.5, 1, 4}, false);  // stands on half of the floor
  const Traced traced = trace(BaseMesh(scene), 0);
  const TransportRow& floor = traced.rows[0];
  EXPECT_TRUE(floor.crosses_contact());
  EXPECT_EQ(std::popcount(floor.hidden_origins), 8);
  EXPECT_EQ(floor.ray_count(), 128u);
  EXPECT_EQ(floor.hits.size(), floor.ray_count());
}

TEST(TransportRows, TwoSidedFacesAreHitOnTheSideThatIsSeen) {
  Scene scene = test::furnace(1, 0.5);
  scene.materials.push_back({"sheet", {}, {0.5, 0.5, 0.5}, true});
  test::add_polygon(scene, {{0, 1, 0}, {0, 1, 4}, {3, 1, 4}, {3, 1, 0}}, 1);  // front up, across the whole room
  const BaseMesh mesh(scene);
  const Traced traced = trace(mesh, 0);
  const std::uint32_t front = 6, back = mesh.roots()[6].twin;
  for (const PatchId& hit : traced.rows[0].hits) EXPECT_NE(hit.root_face(), front);  // from the floor
  for (const PatchId& hit : traced.rows[1].hits) EXPECT_NE(hit.root_face(), back);   // from the ceiling
  EXPECT_EQ(traced.rows[0].hits.size(), traced.rows[0].ray_count());
}

TEST(TransportRows, AppendedRowsCountTheHitsOfEachOrigin) {
  const BaseMesh mesh(test::furnace(1, 0.5));
  TransportRow row = trace(mesh, 0, 1).rows[0];
  const TransportRow more = trace(mesh, 0, 2).rows[0], before = row;
  row.append(more);
  EXPECT_EQ(row.ray_count(), 2u * rays_per_row);
  EXPECT_EQ(row.origin_hits.size(), 2u * origins_per_patch);
  EXPECT_EQ(row.hits.size(), std::accumulate(row.origin_hits.begin(), row.origin_hits.end(), 0u));
  EXPECT_EQ(row.hits[before.hits.size()], more.hits[0]);
}

TEST(TransportRows, AppendedRowsLeaveOutOriginsThatAreHidden) {
  Scene scene = test::furnace(1, 0.5);
  test::add_box(scene, {0, 0, 0}, {1.5, 1, 4}, false);
  const BaseMesh mesh(scene);
  TransportRow row = trace(mesh, 0, 1).rows[0];
  row.append(trace(mesh, 0, 2).rows[0]);
  EXPECT_EQ(row.ray_count(), 256u);
  EXPECT_EQ(row.hits.size(), row.ray_count());
}

// A (0, 2)-net: each of sixteen points in sequence lies alone in its sixteenth of the square, whatever the sixteenth's shape.
TEST(OwenPoints, AreNetsAndEvenOverSeeds) {
  double mean_u = 0, mean_v = 0, product = 0;
  constexpr std::uint32_t seeds = 64;
  for (std::uint32_t seed = 0; seed < seeds; ++seed)
    for (std::uint32_t first = 0; first < 64; first += 16)
      for (int bits_of_u = 0; bits_of_u <= 4; ++bits_of_u) {
        std::set<std::pair<int, int>> cells;
        for (std::uint32_t n = first; n < first + 16; ++n) {
          const Uv at = owen_point(n, seed * 0x9e3779b9u, seed * 0x85ebca6bu + 1);
          ASSERT_TRUE(at.u >= 0 && at.u < 1 && at.v >= 0 && at.v < 1);
          cells.insert({static_cast<int>(std::ldexp(at.u, bits_of_u)), static_cast<int>(std::ldexp(at.v, 4 - bits_of_u))});
          mean_u += at.u, mean_v += at.v, product += (at.u - 0.5) * (at.v - 0.5);
        }
        EXPECT_EQ(cells.size(), 16u) << seed << ' ' << first << ' ' << bits_of_u;
      }
  constexpr double count = seeds * 64 * 5;
  EXPECT_NEAR(mean_u / count, 0.5, 0.005);
  EXPECT_NEAR(mean_v / count, 0.5, 0.005);
  EXPECT_NEAR(product / count, 0, 0.002);
}

// Points 0 and 4 differ first in the third binary digit of u, and so do points 1 and 5. Whether the two points of a pair agree in
// the fourth digit is random for each seed, and independent of the other pair. If digits were exchanged alike for all points, as
// sobol_point() does, both pairs would agree for every seed.
TEST(OwenPoints, ThatDifferInTheThirdDigitAgreeAtRandomInTheFourth) {
  int first = 0, both = 0;
  constexpr int seeds = 4000;
  for (std::uint32_t seed = 0; seed < seeds; ++seed) {
    const auto fourth = [&](std::uint32_t n) { return static_cast<int>(owen_point(n, seed * 0x9e3779b9u, 0).u * 16) & 1; };
    const bool is_first = fourth(0) == fourth(4), is_second = fourth(1) == fourth(5);
    first += is_first, both += is_first && is_second;
  }
  EXPECT_NEAR(first, seeds / 2, 150);
  EXPECT_NEAR(both, seeds / 4, 150);
}

TEST(DirectionSets, WeightsOfEachOriginHaveTheMeanOne) {
  for (const RayPlacing placing : {RayPlacing::nusselt, RayPlacing::hemicube}) {
    const DirectionSets sets(3, placing);
    for (std::uint32_t s = 0; s < DirectionSets::set_count; ++s)
      for (int origin = 0; origin < origins_per_patch; ++origin) {
        double sum = 0;
        for (int r = 0; r < rays_per_origin; ++r) sum += sets[s].weight[static_cast<std::size_t>(origin * rays_per_origin + r)];
        EXPECT_NEAR(sum / rays_per_origin, 1, 1e-6);
      }
  }
}

// The weighted mean of z over cosine-distributed directions is 2/3; its standard error over 32 x 256 directions is below 0.003.
TEST(DirectionSets, BothPlacingsSampleTheCosine) {
  for (const RayPlacing placing : {RayPlacing::nusselt, RayPlacing::hemicube}) {
    const DirectionSets sets(5, placing);
    double mean = 0;
    for (std::uint32_t s = 0; s < DirectionSets::set_count; ++s)
      for (std::size_t n = 0; n < rays_per_row; ++n)
        mean += sets[s].weight[n] * sets[s].z[n] / (rays_per_row * DirectionSets::set_count);
    EXPECT_NEAR(mean, 2.0 / 3, 0.009);
  }
}

}  // namespace
}  // namespace alvor
