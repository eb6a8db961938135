#include "radiosity/exchange/coarse_grid.h"

#include "radiosity/exchange/gathering.h"
#include "tests/radiosity/systems.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

namespace alvor {
namespace {

using test::System;

PatchId deep(std::uint32_t root, std::initializer_list<int> path) {
  PatchId id = PatchId::root(root);
  for (const int k : path) id = id.child(k);
  return id;
}

struct Hits {
  explicit Hits(const System& system) : patch_of_leaf(system.leaves.size()) {
    std::size_t hit = 0;
    for (std::uint32_t p = 0; p < system.patches.size(); ++p) {
      hit_leaf.push_back(system.hit_leaf.data() + hit);
      hit += system.rows[p].hits.size();
      for (std::uint32_t k = 0; k < system.patches[p].leaf_count; ++k) patch_of_leaf[system.patches[p].first_leaf + k] = p;
    }
  }
  RowHits of(const System& system) const { return {system.patches, hit_leaf, patch_of_leaf}; }
  std::vector<const std::uint32_t*> hit_leaf;
  std::vector<std::uint32_t> patch_of_leaf;
};

CoarseUnits one_for_each_patch(const System& system) {
  CoarseUnits units;
  units.count = system.patches.size();
  units.of_patch.resize(units.count);
  std::iota(units.of_patch.begin(), units.of_patch.end(), 0u);
  return units;
}

TEST(CoarseUnits, AncestorsAreAsDeepAsTheirNumberAllows) {
  const std::vector<PatchId> patches{deep(0, {0, 0}), deep(0, {0, 1}), deep(0, {1}), deep(1, {}), deep(2, {3, 3})};
  EXPECT_EQ(ancestors(patches, 5).count, 5u);
  const CoarseUnits four = ancestors(patches, 4);
  EXPECT_EQ(four.count, 4u);
  EXPECT_EQ(four.of_patch[0], four.of_patch[1]);
  EXPECT_NE(four.of_patch[1], four.of_patch[2]);
  EXPECT_EQ(ancestors(patches, 1).count, 3u) << "roots are not joined";
}

TEST(CoarseUnits, PairsJoinThoseThatSeeEachOtherAndNoOthers) {
  // Even patches see only even ones, and odd patches only odd ones.
  System system(1, 32);
  for (std::size_t p = 0, h = 0; p < system.patches.size(); ++p)
    for (const std::size_t end = h + system.rows[p].hits.size(); h < end; ++h)
      system.hit_leaf[h] = system.patches[(2 * (h % 16) + p % 2) % 32].first_leaf;
  CoarseUnits units = one_for_each_patch(system);
  const Hits hits(system);
  join_pairs(units, hits.of(system), 1);
  ASSERT_EQ(units.count, 2u);
  for (std::size_t p = 0; p < units.of_patch.size(); ++p) EXPECT_EQ(units.of_patch[p], units.of_patch[p % 2]);
}

TEST(CoarseUnits, ManyThatSeeOnlyOneJoinItInFewRounds) {
  System system(1, 500);
  std::ranges::fill(system.hit_leaf, system.patches[0].first_leaf);
  CoarseUnits units = one_for_each_patch(system);
  const Hits hits(system);
  EXPECT_LE(join_pairs(units, hits.of(system), 1), 3);
  EXPECT_EQ(units.count, 1u);
}

TEST(CoarseGrid, OfAllPatchesIsTheSolution) {
  const System system(2, 40);
  CoarseUnits units = one_for_each_patch(system);
  const Hits hits(system);
  std::vector<RelativeLight> emission;
  for (const ShootingLeaf& leaf : system.leaves) emission.push_back(leaf.unshot);
  const auto residual = system.gathered(emission);  // the residual at zero irradiance
  auto step = residual;
  CoarseGrid(std::move(units), hits.of(system)).correct(residual, step);
  test::expect_near(step, system.gathered(system.solved()), 1e-9);
}

/// Returns rooms in a row: the patches of a room see each other, and one ray in 64 goes to the next room.
System chain(std::uint32_t rooms, std::uint32_t patches_a_room, double reflectance) {
  System system = System::reciprocal(3, rooms * patches_a_room, reflectance, 1);
  for (std::uint32_t p = 0, h = 0; p < system.patches.size(); ++p) {
    const std::uint32_t room = p / patches_a_room, count = static_cast<std::uint32_t>(system.rows[p].hits.size());
    for (std::uint32_t k = 0; k < count; ++k, ++h) {
      const std::uint32_t next = k > 0 ? room : (p % 2 ? (room + 1) % rooms : (room + rooms - 1) % rooms);
      system.hit_leaf[h] = next * patches_a_room + (p + k) % patches_a_room;
    }
  }
  return system;
}

int sweeps_down_to(double remaining_error, const System& system, std::vector<PatchId> ids) {
  std::vector<std::uint32_t> place(system.leaves.size());
  std::iota(place.begin(), place.end(), 0u);
  std::vector<RelativeLight> emission;
  for (const ShootingLeaf& leaf : system.leaves) emission.push_back(leaf.unshot);
  Gathering gathering(system.patches, place, place.size(), emission, Hits(system).hit_leaf,
                      std::vector<RelativeLight>(system.patches.size()), std::move(ids));
  int sweeps = 0;
  settle(gathering, remaining_error, [&](std::size_t) { return ++sweeps < 10'000; });
  return sweeps;
}

TEST(CoarseGrid, StepsDoNotGrowWithTheRoomsThatLightGoesThroughNorWithWhatTheyReflect) {
  for (const double reflectance : {0.99, 0.9999, 0.999999}) {
    std::vector<int> sweeps;
    for (const std::uint32_t rooms : {10u, 100u}) {
      const System system = chain(rooms, 8, reflectance);
      std::vector<PatchId> ids;
      for (std::uint32_t p = 0; p < system.patches.size(); ++p) ids.push_back(PatchId::root(p));
      sweeps.push_back(sweeps_down_to(1e-6, system, ids));
    }
    EXPECT_LE(sweeps[0], 40) << "rho " << reflectance;
    EXPECT_LE(sweeps[1], 60) << "rho " << reflectance;
  }
}

TEST(CoarseGrid, WithoutItTheStepsAreManyMore) {
  const System system = chain(100, 8, 0.9999);
  std::vector<PatchId> ids;
  for (std::uint32_t p = 0; p < system.patches.size(); ++p) ids.push_back(PatchId::root(p));
  EXPECT_GT(sweeps_down_to(1e-6, system, {}), 3 * sweeps_down_to(1e-6, system, ids));
}

}  // namespace
}  // namespace alvor
