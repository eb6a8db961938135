// Checkpoints: a solve that is interrupted and goes on later gives the same bytes.

#include "radiosity/solve/solver.h"
#include "tests/radiosity/solve_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace alvor {
namespace {

using Bytes = std::vector<std::byte>;

Bytes saved(const SolutionLog& log) {
  return plain_bytes([&](PlainWriter& out) { log.save(out); });
}

struct Saved {
  Bytes state, log;
};

/// The outcome of a solve up to the `n`th place where it may be interrupted, or to its end.
struct Interrupted {
  SolveOutcome outcome;
  Saved saved;
  std::vector<LeafValue> leaves;
  Step last;
};

enum class Places { between_batches, publications_with_an_edit };

Interrupted solve_until(int n, const BaseMesh& mesh, const SolveOptions& options, const Saved& from = {},
                        Places places = Places::between_batches) {
  auto log = std::make_unique<SolutionLog>();
  if (!from.log.empty()) {
    PlainReader in(from.log);
    log = std::make_unique<SolutionLog>(in);
  }
  Interrupted result;
  std::stop_source park;
  SolveControl control;
  control.park = park.get_token();
  const auto pass_place = [&] {
    if (n-- == 0) park.request_stop();
  };
  if (places == Places::publications_with_an_edit) {
    log->listen(pass_place);
    control.is_edited = [&] { return park.stop_requested(); };
  }
  control.is_checkpoint_due = [&] {
    if (places == Places::between_batches) pass_place();
    return false;
  };
  control.save = [&](const SolveControl::Write& write) {
    result.saved.state = plain_bytes(write);
    result.saved.log = saved(*log);
  };
  control.checkpoint = from.state;
  result.outcome = solve_as_planned(mesh, Plan(mesh, options), options, *log, control);
  result.leaves = log->leaves();
  result.last = log->last_step();
  return result;
}

struct Case {
  std::string name;
  Scene (*scene)();
  SolveOptions options;
};
void PrintTo(const Case& one, std::ostream* out) { *out << one.name; }

class Checkpoint : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(
    Scenes, Checkpoint,
    testing::Values(Case{"OneLamp", test::room_with_contacts, {.tolerance = 0.02, .max_leaves = 6000}},
                    Case{"ManyLamps", test::room_with_many_lamps, {.tolerance = 0.03, .max_leaves = 4000}},
                    Case{"Shooting", test::coloured_room, {.tolerance = 0.04, .strategy = Strategy::sorted}},
                    Case{"NothingReflects", test::black_room, {.tolerance = 0.03, .max_leaves = 6000}},
                    Case{"HemicubesInHaze", test::hazy_room, {.tolerance = 0.05, .form_factors = FormFactorMethod::hemicube}},
                    Case{"LampsAndSun", test::room_with_lamps_and_sun, {.tolerance = 0.03, .max_leaves = 5000}},
                    Case{"OvercastSky", test::room_under_overcast_sky, {.tolerance = 0.03, .max_leaves = 5000}},
                    Case{"Furnace", [] { return test::furnace(1, 0.9); }, {}}),
    [](const auto& one) { return one.param.name; });

/// Returns each strategy with each method to find rows, for a closed room that takes several passes.
std::vector<Case> every_strategy_and_method() {
  const std::pair<const char*, Strategy> strategies[]{
      {"Automatic", Strategy::automatic}, {"Gather", Strategy::gather},          {"Shoot", Strategy::shoot},
      {"Sorted", Strategy::sorted},       {"Ambient", Strategy::sorted_ambient}, {"Overshoot", Strategy::overshoot}};
  const std::pair<const char*, FormFactorMethod> methods[]{
      {"Nusselt", FormFactorMethod::nusselt}, {"Hemicube", FormFactorMethod::hemicube}, {"Analytic", FormFactorMethod::analytic}};
  std::vector<Case> cases;
  for (const auto& [strategy_name, strategy] : strategies)
    for (const auto& [method_name, method] : methods)
      cases.push_back({strategy_name + std::string(method_name),
                       test::coloured_room,
                       {.tolerance = 0.05, .max_depth = 3, .max_leaves = 400, .strategy = strategy, .form_factors = method}});
  return cases;
}
INSTANTIATE_TEST_SUITE_P(Every, Checkpoint, testing::ValuesIn(every_strategy_and_method()),
                         [](const auto& one) { return one.param.name; });

TEST_P(Checkpoint, ASolveGoesOnFromItAsIfItHadNotBeenInterrupted) {
  const BaseMesh mesh(GetParam().scene());
  const SolveOptions& options = GetParam().options;
  const Interrupted whole = solve_until(-1, mesh, options);
  int interruptions = 0;
  for (int n = 0;; n += 1 + n / 4) {
    const Interrupted half = solve_until(n, mesh, options);
    if (half.outcome.reason != StopReason::parked) break;
    const Interrupted rest = solve_until(-1, mesh, options, half.saved);
    ++interruptions;
    EXPECT_EQ(rest.outcome.reason, whole.outcome.reason) << n;
    EXPECT_EQ(rest.last.estimated_error, whole.last.estimated_error) << n;
    EXPECT_GE(rest.last.rays, whole.last.rays) << n;
    ASSERT_EQ(rest.leaves, whole.leaves) << n;
  }
  EXPECT_GE(interruptions, 2);
}

TEST(CheckpointOfARun, IsNotOfTheMiddleOfAnExchangeWhereAnEditComesWithTheRequestToPark) {
  const BaseMesh mesh(test::room_with_contacts());
  const SolveOptions options{.tolerance = 0.02, .max_leaves = 6000};
  const Interrupted whole = solve_until(-1, mesh, options);
  for (int n = 0; n < 10; ++n) {
    const Interrupted half = solve_until(n, mesh, options, {}, Places::publications_with_an_edit);
    ASSERT_EQ(half.outcome.reason, StopReason::parked) << n;
    const Interrupted rest = solve_until(-1, mesh, options, half.saved);
    EXPECT_EQ(rest.last.estimated_error, whole.last.estimated_error) << n;
    ASSERT_EQ(rest.leaves, whole.leaves) << n;
  }
}

TEST(CheckpointOfARun, IsMadeAtTheEndOfTheSolveWhereAnEditWaits) {
  const BaseMesh mesh(test::room_with_contacts());
  const SolveOptions options{.tolerance = 0.1, .max_leaves = 6000};
  const auto last = static_cast<int>(solve_until(-1, mesh, options).last.step);
  ASSERT_LT(last, 12) << "later steps are published by the clock";
  const Interrupted ended = solve_until(last, mesh, options, {}, Places::publications_with_an_edit);
  EXPECT_EQ(ended.outcome.reason, StopReason::parked);
  EXPECT_EQ(ended.last.step, last);
  EXPECT_EQ(solve_until(-1, mesh, options, ended.saved).outcome.reason, StopReason::tolerance);
}

TEST(CheckpointOfARun, CountsWhatWasSpentBefore) {
  const BaseMesh mesh(test::room_with_contacts());
  const SolveOptions options{.tolerance = 0.02, .max_leaves = 6000};
  const Interrupted half = solve_until(4, mesh, options);
  const Interrupted rest = solve_until(-1, mesh, options, half.saved);
  EXPECT_GT(rest.outcome.cpu_s, half.outcome.cpu_s);
  EXPECT_GT(rest.outcome.solve_s, half.outcome.solve_s);
  EXPECT_GT(rest.last.rays, half.last.rays);
  EXPECT_GT(rest.last.revision, half.last.revision);
  EXPECT_GT(rest.last.elapsed_s, half.last.elapsed_s);
}

TEST(CheckpointOfARun, IsRefusedWhenCutOffOrOfAnotherScene) {
  const BaseMesh mesh(test::coloured_room());
  const SolveOptions options{.tolerance = 0.02, .max_leaves = 2000};
  const Saved whole = solve_until(3, mesh, options).saved;
  ASSERT_FALSE(whole.state.empty());
  for (std::size_t size = 1; size < whole.state.size(); size += whole.state.size() / 200 + 1) {
    Saved cut = whole;
    cut.state.resize(size);
    EXPECT_THROW(solve_until(-1, mesh, options, cut), BadBytes) << size;
  }
  Saved longer = whole;
  longer.state.push_back({});
  EXPECT_THROW(solve_until(-1, mesh, options, longer), BadBytes);
  Scene other;
  other.materials = {test::grey(1, 0.5)};
  test::add_polygon(other, {{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0}});
  EXPECT_THROW(solve_until(-1, BaseMesh(other), options, whole), BadBytes);
}

TEST(SavedLog, GoesOnAsItWas) {
  const BaseMesh mesh(test::coloured_room());
  SolutionLog log;
  solve(mesh, {.tolerance = 0.05}, log, {});
  const Bytes bytes = saved(log);
  PlainReader in(bytes);
  SolutionLog again(in);
  in.expect_end();
  for (const Detail detail : {Detail::exact, Detail::display}) {
    for (const std::uint64_t base : {std::uint64_t{0}, log.head() / 2, log.head()}) {
      const Delta before = log.since({.base = base}, detail), after = again.since({.base = base}, detail);
      EXPECT_EQ(after.values, before.values);
      EXPECT_EQ(after.steps, before.steps);
      EXPECT_EQ(after.state_hash, before.state_hash);
    }
  }
  EXPECT_FALSE(again.closed());
}

TEST(SavedLog, IsRefusedWhenAnythingIsCutOffOrCannotBe) {
  SolutionLog log;
  log.publish(std::vector<LeafValue>{{PatchId::root(0), {1, 2, 3}}, {PatchId::root(1), {3, 2, 1}}}, {});
  const Bytes whole = saved(log);
  const auto load = [](const Bytes& bytes) {
    PlainReader in(bytes);
    SolutionLog loaded(in);
    in.expect_end();
  };
  EXPECT_NO_THROW(load(whole));
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_THROW(load(Bytes(whole.begin(), whole.begin() + size)), BadBytes);
  // A log with one byte inverted is either refused or can be read and asked without fault.
  for (std::size_t place = 0; place < whole.size(); ++place) {
    Bytes changed = whole;
    changed[place] ^= std::byte{0xff};
    try {
      PlainReader in(changed);
      SolutionLog loaded(in);
      loaded.since({}, Detail::display);
      loaded.leaves();
    } catch (const BadBytes&) {}
  }
}

}  // namespace
}  // namespace alvor
