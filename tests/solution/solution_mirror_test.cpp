#include "solution/solution_mirror.h"

#include <gtest/gtest.h>

#include <random>

namespace alvor {
namespace {

const PatchId root = PatchId::root(4);

Delta delta(std::uint64_t from, std::uint64_t to, std::vector<LeafValue> values) {
  return {from, to, to, {to}, std::move(values), {}};
}

TEST(SolutionMirror, DeeperValueImpliesSplitsAndSiblingsInherit) {
  SolutionMirror mirror;
  ASSERT_FALSE(mirror.apply(delta(0, 1, {{root, {1, 1, 1}}})));
  ASSERT_FALSE(mirror.apply(delta(1, 2, {{root.child(2).child(0), {5, 5, 5}}})));
  EXPECT_EQ(mirror.leaf_count(), 7u);
  for (const LeafValue& leaf : mirror.leaves()) EXPECT_EQ(leaf.irradiance.r, leaf.patch == root.child(2).child(0) ? 5 : 1);
}

TEST(SolutionMirror, RefusesAGapAndStaysAsItWas) {
  SolutionMirror mirror;
  ASSERT_FALSE(mirror.apply(delta(0, 3, {{root, {1, 2, 3}}})));
  const auto before = mirror.leaves();
  EXPECT_TRUE(mirror.apply(delta(4, 5, {{root, {9, 9, 9}}})));
  EXPECT_TRUE(mirror.apply(delta(3, 2, {})));
  EXPECT_EQ(mirror.leaves(), before);
  EXPECT_EQ(mirror.revision(), 3u);
}

TEST(SolutionMirror, RefusesBadAndOverlappingPatchesWhole) {
  SolutionMirror mirror;
  ASSERT_FALSE(mirror.apply(delta(0, 1, {{root.child(1), {1, 1, 1}}})));
  const auto before = mirror.leaves();
  EXPECT_TRUE(mirror.apply(delta(1, 2, {{root.child(2), {2, 2, 2}}, {PatchId::from_bits(8), {}}})));
  EXPECT_TRUE(mirror.apply(delta(1, 2, {{root, {2, 2, 2}}}))) << "coarser than held";
  EXPECT_TRUE(mirror.apply(delta(1, 2, {{root.child(1).child(0), {}}, {root.child(1), {}}}))) << "one inside the other";
  EXPECT_EQ(mirror.leaves(), before);
}

/// A writer that splits and changes leaves at random.
class RandomWriter {
 public:
  explicit RandomWriter(unsigned seed) : random_(seed) { leaves_ = {PatchId::root(0), PatchId::root(1), PatchId::root(2)}; }
  void publish(SolutionLog& log) {
    std::vector<LeafValue> changed;
    if (random_() % 2) split(changed);
    for (unsigned n = random_() % 4; n > 0; --n) changed.push_back(fresh(leaves_[random_() % leaves_.size()]));
    log.publish(changed, {});
  }

 private:
  void split(std::vector<LeafValue>& changed) {
    const std::size_t n = random_() % leaves_.size();
    const PatchId parent = leaves_[n];
    if (parent.level() == PatchId::max_level) return;
    leaves_.erase(leaves_.begin() + static_cast<std::ptrdiff_t>(n));
    for (int k = 0; k < 4; ++k) changed.push_back(fresh(parent.child(k)));
    for (int k = 0; k < 4; ++k) leaves_.push_back(parent.child(k));
  }
  LeafValue fresh(PatchId patch) { return {patch, {float(random_()), float(random_()), float(random_())}}; }
  std::mt19937 random_;
  std::vector<PatchId> leaves_;
};

TEST(SolutionMirror, AnyPacingAndPagingEndsEqualToTheLog) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    std::mt19937 random(seed);
    RandomWriter writer(seed + 1000);
    SolutionLog log;
    SolutionMirror mirror;
    Cursor cursor;
    const auto read_a_page = [&] {
      const Delta page = log.since(cursor, 1 + random() % 9);
      const auto fault = mirror.apply(page);
      ASSERT_FALSE(fault) << *fault << " seed " << seed;
      cursor = page.next;
    };
    for (int n = 0; n < 60; ++n) {
      writer.publish(log);
      for (unsigned pages = random() % 3; pages > 0; --pages) read_a_page();
      if (random() % 10 == 0) cursor = {mirror.revision()};  // a reconnect goes on from what is complete
    }
    while (!mirror.whole() || mirror.revision() != log.head()) read_a_page();
    for (const LeafValue& leaf : log.leaves()) {
      const auto leaves = mirror.leaves();
      const auto found = std::ranges::lower_bound(leaves, leaf.patch, {}, &LeafValue::patch);
      ASSERT_TRUE(found != leaves.end() && *found == leaf) << "seed " << seed;
    }
  }
}

}  // namespace
}  // namespace alvor
