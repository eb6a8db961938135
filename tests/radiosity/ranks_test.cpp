// Several ranks solve as one does.

#include "radiosity/ranks/deal.h"
#include "radiosity/solve/pass.h"
#include "radiosity/solve/solver.h"
#include "tests/radiosity/solve_scenes.h"
#include "tests/thread_ranks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>

namespace alvor {
namespace {

using Bytes = std::vector<std::byte>;

struct Case {
  std::string name;
  Scene (*scene)();
  SolveOptions options;
};
void PrintTo(const Case& one, std::ostream* out) { *out << one.name; }

struct Saved {
  Bytes state, log;
};

/// The outcome of a solve: of all of it, or up to the `n`th place where it may be interrupted.
struct Solved {
  SolveOutcome outcome;
  std::vector<LeafValue> leaves;
  Step last;
  Saved saved;
};

/// How one rank takes part in a solve, besides what all have in common.
struct Part {
  int park_at = -1;  ///< the first rank asks to park at the n-th place where that is possible; negative: never
  std::stop_token stop;
};

Solved solve_on(Ranks& ranks, const Case& one, const Part& part, const Saved& from) {
  const BaseMesh mesh(one.scene());
  SolveOptions options = one.options;
  options.threads = 1;
  auto log = std::make_unique<SolutionLog>();
  if (ranks.is_first() && !from.log.empty()) {
    PlainReader in(from.log);
    log = std::make_unique<SolutionLog>(in);
  }
  Solved solved;
  std::stop_source park;
  int places = part.park_at;
  SolveControl control{.stop = part.stop, .park = park.get_token(), .checkpoint = from.state, .ranks = &ranks};
  if (ranks.is_first()) {
    control.is_checkpoint_due = [&] {
      if (places-- == 0) park.request_stop();
      return false;
    };
    control.save = [&](const SolveControl::Write& write) {
      solved.saved.state = plain_bytes(write);
      solved.saved.log = plain_bytes([&](PlainWriter& out) { log->save(out); });
    };
  }
  solved.outcome = solve_as_planned(mesh, Plan(mesh, options), options, *log, control);
  if (ranks.is_first()) {
    solved.leaves = log->leaves();
    solved.last = log->last_step();
  }
  return solved;
}

Solved solve_with(std::size_t size, const Case& one, const Part& part = {}, const Saved& from = {}) {
  if (size == 1) return solve_on(Ranks::alone(), one, part, from);
  Solved solved;
  test::ThreadRanks::run(size, [&](Ranks& ranks) {
    Solved here = solve_on(ranks, one, part, from);
    if (ranks.is_first()) solved = std::move(here);
  });
  return solved;
}

void expect_equal(const Solved& a, const Solved& b, const std::string& what) {
  EXPECT_EQ(a.outcome.reason, b.outcome.reason) << what;
  EXPECT_EQ(a.last.estimated_error, b.last.estimated_error) << what;
  EXPECT_EQ(a.last.rays, b.last.rays) << what;
  EXPECT_EQ(a.last.leaves, b.last.leaves) << what;
  EXPECT_EQ(a.outcome.balance.absorbed, b.outcome.balance.absorbed) << what;
  EXPECT_TRUE(a.leaves == b.leaves) << what;
}

const Case one_lamp{"OneLamp", test::room_with_contacts, {.tolerance = 0.01, .max_leaves = 12'000}};

class SeveralRanks : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(
    Scenes, SeveralRanks,
    testing::Values(one_lamp, Case{"ManyLamps", test::room_with_many_lamps, {.tolerance = 0.03, .max_leaves = 4000}},
                    Case{"NothingReflects", test::black_room, {.tolerance = 0.03, .max_leaves = 6000}},
                    Case{"HemicubesInHaze", test::hazy_room, {.tolerance = 0.05, .form_factors = FormFactorMethod::hemicube}},
                    Case{"ExactRows",
                         test::coloured_room,
                         {.tolerance = 0.05, .max_depth = 3, .max_leaves = 400, .form_factors = FormFactorMethod::analytic}},
                    Case{"LampsAndSun", test::room_with_lamps_and_sun, {.tolerance = 0.03, .max_leaves = 5000}},
                    Case{"Furnace", [] { return test::furnace(1, 0.9); }, {}},
                    Case{"Curtain", test::curtained_room, {.tolerance = 0.03, .max_leaves = 4000}},
                    Case{"Tiles", test::tiled_room, {.tolerance = 0.03, .max_leaves = 5000}}),
    [](const auto& one) { return one.param.name; });

TEST_P(SeveralRanks, FindTheBytesThatOneFinds) {
  const Solved alone = solve_with(1, GetParam());
  EXPECT_GT(alone.leaves.size(), 5u);
  for (const std::size_t size : {2, 3, 4}) expect_equal(solve_with(size, GetParam()), alone, std::to_string(size) + " ranks");
}

TEST_P(SeveralRanks, GoOnFromWhatOtherNumbersOfRanksSaved) {
  const Solved whole = solve_with(1, GetParam());
  for (const int park_at : {1, 4, 8})
    for (const auto& [before, after] : {std::pair<std::size_t, std::size_t>{3, 1}, {1, 2}, {2, 4}}) {
      const Solved half = solve_with(before, GetParam(), {.park_at = park_at});
      EXPECT_TRUE(half.outcome.reason == StopReason::parked || park_at > 1);
      if (half.outcome.reason != StopReason::parked) continue;  // it was finished by then
      const Solved rest = solve_with(after, GetParam(), {}, half.saved);
      EXPECT_EQ(rest.last.estimated_error, whole.last.estimated_error);
      EXPECT_TRUE(rest.leaves == whole.leaves) << before << " ranks, then " << after;
    }
}

TEST(Ranks, SaveTheSameStateWhateverTheirNumber) {
  const Bytes alone = solve_with(1, one_lamp, {.park_at = 5}).saved.state;
  const Bytes three = solve_with(3, one_lamp, {.park_at = 5}).saved.state;
  ASSERT_FALSE(alone.empty());
  EXPECT_EQ(alone.size(), three.size());
}

TEST(Ranks, AllEndWhenOneIsAskedToStop) {
  std::stop_source stop;
  stop.request_stop();
  for (std::size_t asked = 0; asked < 3; ++asked)
    test::ThreadRanks::run(3, [&](Ranks& ranks) {
      const Part part{.stop = ranks.rank() == asked ? stop.get_token() : std::stop_token()};
      EXPECT_EQ(solve_on(ranks, one_lamp, part, {}).outcome.reason, StopReason::cancelled) << ranks.rank();
    });
}

TEST(Ranks, RefuseTextbookStrategies) {
  const Case shooting{"Shooting", test::coloured_room, {.strategy = Strategy::sorted}};
  test::ThreadRanks::run(2, [&](Ranks& ranks) { EXPECT_THROW(solve_on(ranks, shooting, {}, {}), std::invalid_argument); });
}

TEST(Ranks, HoldEachRowsHitsOnOneOfThem) {
  const BaseMesh mesh(test::room_with_contacts());
  std::vector<std::size_t> hits_of_rank(4);
  std::size_t all_alone = 0;
  const auto hits_on = [&](Ranks& ranks) {
    RayBudget budget([] { return false; });
    SolveState state(mesh, Plan(mesh, {}), {.max_leaves = 20'000}, budget, ranks);
    for (int pass = 0; pass < 3; ++pass) {
      Pass next(state);
      next.prepare().sweep();
      next.estimate();
      next.refine();
    }
    std::size_t hits = 0;
    for (const NodeIndex row : state.forests.rows().leaves()) hits += state.rows[row].hits.size();
    return hits;
  };
  all_alone = hits_on(Ranks::alone());
  test::ThreadRanks::run(4, [&](Ranks& ranks) { hits_of_rank[ranks.rank()] = hits_on(ranks); });
  std::size_t sum = 0;
  for (const std::size_t hits : hits_of_rank) {
    sum += hits;
    EXPECT_NEAR(static_cast<double>(hits) / static_cast<double>(all_alone), 0.25, 0.05);
  }
  EXPECT_EQ(sum, all_alone);
}

/// Returns the largest number of these patches that one rank gets, over the mean.
double unevenness(std::span<const PatchId> patches, std::size_t ranks) {
  std::vector<std::size_t> count(ranks);
  for (const PatchId patch : patches) ++count[worker_of(patch, ranks)];
  return static_cast<double>(std::ranges::max(count) * ranks) / static_cast<double>(patches.size());
}

TEST(Ranks, GetEquallyManyPatches) {
  std::vector<PatchId> roots, leaves;
  for (std::uint32_t root = 0; root < 10'000; ++root) roots.push_back(PatchId::root(root));
  for (std::uint32_t root = 0; root < 10; ++root) {
    std::vector<PatchId> level{PatchId::root(root)};
    for (int depth = 0; depth < 5; ++depth) {
      std::vector<PatchId> children;
      for (const PatchId patch : level)
        for (int k = 0; k < 4; ++k) children.push_back(patch.child(k));
      level = std::move(children);
    }
    leaves.insert(leaves.end(), level.begin(), level.end());
  }
  for (const std::size_t ranks : {2, 3, 4, 8, 32}) {
    EXPECT_LT(unevenness(roots, ranks), 1.02) << ranks;
    EXPECT_LT(unevenness(leaves, ranks), 1.1) << ranks;
  }
}

}  // namespace
}  // namespace alvor
