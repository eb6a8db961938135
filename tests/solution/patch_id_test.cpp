#include "solution/patch_id.h"

#include <gtest/gtest.h>

namespace alvor {
namespace {

TEST(PatchId, DefaultIsNoPatch) { EXPECT_FALSE(PatchId().is_valid()); }

TEST(PatchId, RootHasLevelZeroAndItsFace) {
  const PatchId root = PatchId::root(0xfffffffeu);
  EXPECT_TRUE(root.is_valid());
  EXPECT_TRUE(root.is_root());
  EXPECT_EQ(root.level(), 0);
  EXPECT_EQ(root.root_face(), 0xfffffffeu);
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

TEST(PatchId, BitsThatNameNoPatchAreInvalid) {
  for (const std::uint64_t low : {0x0u, 0x2u, 0x80000000u, 0xffffffffu, 0x8u})
    EXPECT_FALSE(PatchId::from_bits(std::uint64_t{5} << 32 | low).is_valid()) << low;
}

}  // namespace
}  // namespace alvor
