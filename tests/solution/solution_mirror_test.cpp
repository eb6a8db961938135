#include "solution/solution_mirror.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <random>
#include <utility>

namespace alvor {
namespace {

const PatchId root = PatchId::root(4);

Delta delta(std::uint64_t from, std::uint64_t to, std::vector<LeafValue> values) {
  Delta made;
  made.from_revision = from;
  made.to_revision = made.head = to;
  made.values = std::move(values);
  return made;
}

TEST(SolutionMirror, DeeperValueImpliesSplitsAndSiblingsInherit) {
  SolutionMirror mirror;
  ASSERT_FALSE(mirror.apply(delta(0, 1, {{root, {1, 1, 1}}})));
  ASSERT_FALSE(mirror.apply(delta(1, 2, {{root.child(2).child(0), {5, 5, 5}}})));
  EXPECT_EQ(mirror.leaf_count(), 7u);
  for (const LeafValue& leaf : mirror.leaves()) EXPECT_EQ(leaf.irradiance.r, leaf.patch == root.child(2).child(0) ? 5 : 1);
}

TEST(SolutionMirror, ACoarserValueMakesTheLeavesWithinOne) {
  SolutionMirror mirror;
  ASSERT_FALSE(mirror.apply(delta(0, 1, {{root.child(1).child(0), {1, 1, 1}}, {root.child(2).child(3), {2, 2, 2}}})));
  ASSERT_FALSE(mirror.apply(delta(1, 2, {{root.child(0).child(0), {3, 3, 3}}, {root.child(1), {5, 5, 5}}})));
  EXPECT_EQ(mirror.leaf_count(), 10u) << "four, one, four, one";
  for (const LeafValue& leaf : mirror.leaves()) EXPECT_EQ(leaf.patch == root.child(1), leaf.irradiance.r == 5);
  ASSERT_FALSE(mirror.apply(delta(2, 3, {{root, {7, 7, 7}}})));
  EXPECT_EQ(mirror.leaves(), (std::vector<LeafValue>{{root, {7, 7, 7}}}));
}

TEST(SolutionMirror, APatchThatIsSplitInAnotherWayIsOneLeafBefore) {
  SolutionMirror mirror;
  EXPECT_FALSE(mirror.apply(delta(0, 1, {{root.child(0), {1, 1, 1}}, {root.child(3), {4, 4, 4}}})));
  EXPECT_FALSE(mirror.apply(delta(1, 2, {{root.child(1, Split::slabs_along_v), {9, 9, 9}}})));
  std::vector<LeafValue> leaves;
  for (int k = 0; k < 4; ++k) leaves.push_back({root.child(k, Split::slabs_along_v), k == 1 ? RgbF{9, 9, 9} : RgbF{1, 1, 1}});
  EXPECT_EQ(mirror.leaves(), leaves);
}

TEST(SolutionMirror, RefusesLeavesThatContradictEachOther) {
  SolutionMirror mirror;
  EXPECT_TRUE(mirror.apply(delta(0, 1, {{root.child(0), {1, 1, 1}}, {root.child(3, Split::slabs_along_u), {4, 4, 4}}})));
  EXPECT_TRUE(mirror.leaves().empty());
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
  EXPECT_TRUE(mirror.apply(delta(1, 2, {{root.child(1).child(0), {}}, {root.child(1), {}}}))) << "one inside the other";
  EXPECT_EQ(mirror.leaves(), before);
}

/// Publishes random splits, merges and changes of leaves.
class RandomWriter {
 public:
  explicit RandomWriter(unsigned seed) : random_(seed) { leaves_ = {PatchId::root(0), PatchId::root(1), PatchId::root(2)}; }
  void publish(SolutionLog& log) {
    std::vector<LeafValue> changed;
    if (random_() % 2) split(changed);
    else if (random_() % 4 == 0) merge(changed);
    for (unsigned n = random_() % 4; n > 0; --n) changed.push_back(fresh(leaves_[random_() % leaves_.size()]));
    std::ranges::sort(changed, {}, &LeafValue::patch);
    const auto repeated = std::ranges::unique(changed, {}, &LeafValue::patch);
    changed.erase(repeated.begin(), repeated.end());
    Step step;
    step.displayed_error = random_() % 2 ? 0.3 : 0;
    std::vector<float> errors;
    if (random_() % 4 == 0)
      for (std::size_t n = 0; n < changed.size(); ++n) errors.push_back(float(random_() % 1000));
    log.publish(changed, step, errors);
  }

 private:
  void split(std::vector<LeafValue>& changed) {
    const std::size_t n = random_() % leaves_.size();
    const PatchId parent = leaves_[n];
    Split how = static_cast<Split>(random_() % 3);
    if (!parent.may_split(how)) how = Split::quarters;
    if (!parent.may_split(how)) return;
    leaves_.erase(leaves_.begin() + static_cast<std::ptrdiff_t>(n));
    for (int k = 0; k < 4; ++k) leaves_.push_back(parent.child(k, how));
    for (int k = 0; k < 4; ++k) changed.push_back(fresh(parent.child(k, how)));
  }
  void merge(std::vector<LeafValue>& changed) {
    const PatchId leaf = leaves_[random_() % leaves_.size()];
    PatchId whole = leaf;
    for (int levels = 1 + static_cast<int>(random_() % 2); levels > 0 && whole.level() > 0; --levels) whole = whole.parent();
    if (whole == leaf) return;
    std::erase_if(leaves_, [&](PatchId patch) { return whole.contains(patch); });
    const Split how = static_cast<Split>(random_() % 3);
    if (random_() % 2 == 0 || !whole.may_split(how)) {
      leaves_.push_back(whole);
      changed.push_back(fresh(whole));
      return;
    }
    // At once split anew, often in another way; of its children one alone may be told.
    for (int k = 0; k < 4; ++k) leaves_.push_back(whole.child(k, how));
    const bool tells_all = random_() % 2 == 0;
    for (int k = 0; k < 4; ++k)
      if (tells_all || k == 2) changed.push_back(fresh(whole.child(k, how)));
  }
  LeafValue fresh(PatchId patch) { return {patch, {float(random_()), float(random_()), float(random_())}}; }
  std::mt19937 random_;
  std::vector<PatchId> leaves_;
};

/// A stream that loses, repeats, swaps and cuts pages, and its watcher. The watcher continues from the last complete revision,
/// and starts from nothing when the hash says that its state is wrong.
class BadStream {
 public:
  BadStream(const SolutionLog& log, Detail detail, unsigned seed) : log_(log), detail_(detail), random_(seed) {}
  const SolutionMirror& mirror() const { return mirror_; }
  bool is_up_to_date() const {
    return mirror_.whole() && mirror_.revision() == log_.head() && !log_.has_errors_after(cursor_.errors);
  }

  void read_a_page() {
    const Delta page = next_page();
    if (is_bad_day(12)) return;
    if (is_bad_day(12)) held_back_ = page;
    else receive(page);
    if (is_bad_day(12)) receive(page);
    if (held_back_ && is_bad_day(2)) receive(*std::exchange(held_back_, std::nullopt));
  }
  void finish() {
    is_good_ = true;
    cursor_ = from_mirror();
    while (!is_up_to_date()) read_a_page();
  }

 private:
  bool is_bad_day(unsigned one_in) { return !is_good_ && random_() % one_in == 0; }
  Delta next_page() {
    if (is_good_ || is_bad_day(10)) cursor_ = cursor_.base == mirror_.revision() ? cursor_ : from_mirror();
    Delta page = log_.since(cursor_, detail_, 1 + random_() % 9);
    cursor_ = page.next;
    return page;
  }
  void receive(const Delta& page) {
    const bool fits = page.from_revision == mirror_.revision();
    if (!mirror_.apply(page)) return;
    if (fits) mirror_ = {};  // the hash was wrong
    cursor_ = from_mirror();
  }
  /// As a client does that connects again: it asks for all errors anew.
  Cursor from_mirror() const { return {.base = mirror_.revision(), .errors = {.are_wanted = true}}; }

  const SolutionLog& log_;
  Detail detail_;
  std::mt19937 random_;
  SolutionMirror mirror_;
  Cursor cursor_;
  std::optional<Delta> held_back_;
  bool is_good_ = false;
};

TEST(SolutionMirror, WhateverTheStreamDoesEndsEqualToTheLog) {
  for (unsigned seed = 0; seed < 10'000; ++seed) {
    RandomWriter writer(seed + 100'000);
    SolutionLog log;
    const Detail detail = seed % 2 ? Detail::display : Detail::exact;
    BadStream stream(log, detail, seed);
    std::mt19937 random(seed);
    for (int n = 0; n < 25; ++n) {
      writer.publish(log);
      for (unsigned pages = random() % 4; pages > 0; --pages) stream.read_a_page();
    }
    stream.finish();
    ASSERT_EQ(stream.mirror().leaves(), log.leaves(detail)) << "seed " << seed;
    SolutionMirror fresh;
    ASSERT_FALSE(fresh.apply(log.since({.errors = {.are_wanted = true}}, detail)));
    ASSERT_TRUE(std::ranges::equal(stream.mirror().errors(), fresh.errors())) << "seed " << seed;
  }
}

TEST(SolutionMirror, TellsAStateThatIsNotTheServers) {
  SolutionLog log;
  SolutionMirror mirror;
  log.publish(std::vector<LeafValue>{{root, {1, 1, 1}}}, {});
  Delta delta = log.since({});
  delta.values[0].irradiance.g = 2;
  const auto fault = mirror.apply(delta);
  ASSERT_TRUE(fault);
  EXPECT_NE(fault->find("hash"), std::string::npos) << *fault;
}

TEST(SolutionMirror, ErrorsComeInPagesAndSplitsPassThemOn) {
  SolutionLog log;
  std::vector<LeafValue> leaves;
  std::vector<float> errors;
  for (std::uint32_t n = 0; n < 40; ++n) leaves.push_back({PatchId::root(n), {1, 1, 1}}), errors.push_back(float(n));
  log.publish(leaves, {}, errors);
  SolutionMirror mirror;
  Cursor cursor{.errors = {.are_wanted = true}};
  const auto read = [&](std::size_t values) {
    const Delta page = log.since(cursor, Detail::exact, values);
    EXPECT_EQ(mirror.apply(page), std::nullopt);
    EXPECT_EQ(mirror.misses_errors(), log.has_errors_after(page.next.errors));
    cursor = page.next;
  };
  for (int n = 0; n < 20; ++n) read(2);
  EXPECT_EQ(mirror.errors().size(), 40u) << "the last page of values tells the first thirty errors";
  EXPECT_TRUE(mirror.misses_errors());
  // Between the pages, the last leaf that was told and one that was not are split.
  log.publish(std::vector<LeafValue>{{PatchId::root(29).child(2), {2, 2, 2}}, {PatchId::root(35).child(0), {3, 3, 3}}}, {});
  while (log.has_errors_after(cursor.errors) || !mirror.whole()) read(2);
  ASSERT_EQ(mirror.errors().size(), 46u);
  const auto all = mirror.leaves();
  for (std::size_t n = 0; n < all.size(); ++n)
    EXPECT_NEAR(mirror.errors()[n], all[n].patch.root_face(), 0.045 * all[n].patch.root_face()) << n;
}

TEST(SolutionMirror, ErrorsOfLeavesThatAreNotThereAreAFault) {
  for (const PatchId first : {root.child(1), PatchId::root(3)}) {
    SolutionMirror mirror;
    Delta bad = delta(0, 1, {{root, {1, 1, 1}}});
    bad.errors = {first, ErrorCoding(0), {8}};
    EXPECT_TRUE(mirror.apply(bad));
  }
  SolutionMirror mirror;
  Delta bad = delta(0, 1, {{root, {1, 1, 1}}});
  bad.errors = {root, ErrorCoding(0), {8, 8}};
  EXPECT_TRUE(mirror.apply(bad));
}

TEST(ErrorCoding, RoundsByLessThanAFifthOfAnOctaveOverNineDigits) {
  for (const float largest : {1e-20f, 1.0f, 3e30f}) {
    const ErrorCoding coding = ErrorCoding::for_errors_up_to(largest);
    for (float error = largest; error > 1e-9f * largest; error *= 0.83f)
      EXPECT_NEAR(coding.unpack(coding.pack(error)) / error, 1, 0.045) << error;
    EXPECT_EQ(coding.unpack(coding.pack(0)), 0);
    EXPECT_GT(coding.unpack(coding.pack(1e-15f * largest)), 0) << "only no error is told as none";
  }
}

}  // namespace
}  // namespace alvor
