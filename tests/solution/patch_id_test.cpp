#include "solution/patch_id.h"

#include <gtest/gtest.h>

#include <vector>

namespace alvor {
namespace {

TEST(PatchId, DefaultIsNoPatch) { EXPECT_FALSE(PatchId().is_valid()); }

TEST(PatchId, RootHasLevelZeroAndItsFace) {
  const PatchId root = PatchId::root(PatchId::most_roots - 1);
  EXPECT_TRUE(root.is_valid());
  EXPECT_TRUE(root.is_root());
  EXPECT_EQ(root.level(), 0);
  EXPECT_EQ(root.root_face(), PatchId::most_roots - 1);
}

TEST(PatchId, ParentUndoesChildAtEveryLevel) {
  PatchId patch = PatchId::root(7);
  for (int level = 1; level <= PatchId::max_level; ++level) {
    const int k = (level * 7) % 4;
    const PatchId child = patch.child(k);
    EXPECT_TRUE(child.is_valid());
    EXPECT_EQ(child.level(), level);
    EXPECT_EQ(child.parent(), patch);
    EXPECT_EQ(child.child_index(level), k);
    EXPECT_EQ(child.ancestor(level - 1), patch);
    EXPECT_EQ(child.root_face(), 7u);
    patch = child;
  }
}

TEST(PatchId, ContainsItsDescendantsAndNothingElse) {
  const PatchId patch = PatchId::root(3).child(2).child(1);
  EXPECT_TRUE(patch.contains(patch));
  EXPECT_TRUE(patch.contains(patch.child(0).child(3)));
  EXPECT_FALSE(patch.contains(patch.parent()));
  EXPECT_FALSE(patch.contains(PatchId::root(3).child(2).child(2)));
  EXPECT_FALSE(patch.contains(PatchId::root(4).child(2).child(1)));
}

TEST(PatchId, SortsDepthFirst) {
  const PatchId root = PatchId::root(1);
  EXPECT_LT(root.child(0), root);
  EXPECT_LT(root, root.child(3));
  EXPECT_LT(root.child(0).child(3), root.child(1).child(0));
  EXPECT_LT(root.range_max(), PatchId::root(2).range_min());
}

TEST(PatchId, FinestNamesEveryLevelOfItsPath) {
  const PatchId finest = PatchId::finest(9, 0b11'00'01'10'00'00'00'00'00'00'00'00'00'00'00);
  EXPECT_EQ(finest.level(), PatchId::max_level);
  EXPECT_EQ(finest.ancestor(4), PatchId::root(9).child(3).child(0).child(1).child(2));
}

/// Returns a patch whose ancestors are split as told, always into child 2.
PatchId below(const std::vector<Split>& splits) {
  PatchId patch = PatchId::root(5);
  for (const Split how : splits) patch = patch.child(2, how);
  return patch;
}

TEST(PatchId, TellsAtWhichLevelsThereAreSlabs) {
  constexpr Split q = Split::quarters, u = Split::slabs_along_u, v = Split::slabs_along_v;
  for (const std::vector<Split>& splits : {std::vector{u}, {v, v}, {q, u, q, q}, {u, q, v}, {q, q, v, u, q}, {q, u, u}}) {
    const PatchId patch = below(splits);
    EXPECT_TRUE(patch.is_valid());
    EXPECT_EQ(patch.level(), int(splits.size()));
    EXPECT_EQ(patch.root_face(), 5u);
    int halvings_of_u = 0, halvings_of_v = 0;
    for (int level = 1; level <= patch.level(); ++level) {
      const Split how = splits[static_cast<std::size_t>(level - 1)];
      EXPECT_EQ(patch.split_above(level), how);
      EXPECT_EQ(patch.child_index(level), 2);
      EXPECT_EQ(patch.ancestor(level), below({splits.begin(), splits.begin() + level}));
      halvings_of_u += how == q ? 1 : how == u ? 2 : 0;
      halvings_of_v += how == q ? 1 : how == v ? 2 : 0;
    }
    EXPECT_EQ(patch.halvings_of_u(), halvings_of_u);
    EXPECT_EQ(patch.halvings_of_v(), halvings_of_v);
    EXPECT_EQ(patch.parent(), below({splits.begin(), splits.end() - 1}));
    EXPECT_EQ(patch.mirrored(6).mirrored(5), patch);
    EXPECT_EQ(patch.mirrored(6).split_above(patch.level()), mirrored(splits.back()));
    EXPECT_TRUE(patch.ancestor(0).contains(patch));
    for (int k = 0; k < 4; ++k) EXPECT_EQ(patch.sibling(k), patch.parent().child(k, splits.back()));
  }
}

TEST(PatchId, HasSlabsAtTwoLevelsAtMost) {
  const PatchId twice = below({Split::slabs_along_u, Split::quarters, Split::slabs_along_v});
  EXPECT_TRUE(twice.may_split(Split::quarters));
  EXPECT_FALSE(twice.may_split(Split::slabs_along_u));
  EXPECT_FALSE(twice.may_split(Split::slabs_along_v));
}

TEST(PatchId, NoCoordinateIsHalvedMoreOftenThanTheGridAllows) {
  PatchId patch = below({Split::slabs_along_u});
  while (patch.may_split(Split::quarters)) patch = patch.child(3);
  EXPECT_EQ(patch.halvings_of_u(), PatchId::max_level);
  EXPECT_FALSE(patch.may_split(Split::slabs_along_u));
  EXPECT_TRUE(patch.is_valid());
}

TEST(PatchId, ContradictionsAboutSlabsAreSeen) {
  const PatchId slab = PatchId::root(1).child(0, Split::slabs_along_u), quarter = PatchId::root(1).child(1);
  EXPECT_FALSE(slab.agrees_on_splits(quarter));
  EXPECT_FALSE(slab.agrees_on_splits(PatchId::root(1).child(1, Split::slabs_along_v)));
  EXPECT_TRUE(slab.agrees_on_splits(PatchId::root(1).child(1, Split::slabs_along_u)));
  EXPECT_TRUE(quarter.agrees_on_splits(PatchId::root(1).child(2).child(1, Split::slabs_along_u)));
  EXPECT_TRUE(slab.agrees_on_splits(PatchId::root(2).child(0)));
}

TEST(PatchId, CodesThatNameNoSlabsAreInvalid) {
  const PatchId patch = PatchId::root(1).child(1).child(2);
  const int first_at_level_1 = 1 + 2 * 1, at_level_2 = 1 + 2 * 2, beyond_the_grid = 31;
  EXPECT_TRUE(patch.with_slab_code(first_at_level_1).is_valid());
  EXPECT_FALSE(patch.with_slab_code(at_level_2).is_valid()) << "its own level";
  EXPECT_FALSE(patch.with_slab_code(beyond_the_grid).is_valid());
  EXPECT_FALSE(patch.with_slab_code(first_at_level_1 << 5).is_valid()) << "a second without a first";
  EXPECT_FALSE(patch.with_slab_code(first_at_level_1 | first_at_level_1 << 5).is_valid()) << "twice the same";
}

TEST(PatchId, BitsThatNameNoPatchAreInvalid) {
  for (const std::uint64_t low : {0x0u, 0x2u, 0x80000000u, 0xffffffffu, 0x8u})
    EXPECT_FALSE(PatchId::from_bits(std::uint64_t{5} << 32 | low).is_valid()) << low;
}

}  // namespace
}  // namespace alvor
