#include "server/solves/solve_store.h"

#include "tests/server/kept_directory.h"
#include "tests/server/refusal.h"
#include "tests/server/sample_scenes.h"
#include "tests/server/staged_solver.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <semaphore>
#include <thread>

namespace alvor {
namespace {

class SolveStoreTest : public testing::Test {
 protected:
  static SolveStoreOptions options_for(StagedSolver& stage) {
    SolveStoreOptions options;
    options.max_running = 2;
    options.max_waiting = 2;
    options.solver = stage.solver();
    return options;
  }
  std::shared_ptr<StoredSolve> create() { return solves.create(scenes.use(scene), {}); }
  static v1::Solve ended(const std::shared_ptr<StoredSolve>& solve) {
    // The state is final before the log's listeners are woken for the last time, but those who wait for the log may be woken
    // earlier.
    while (!solve->ended()) std::this_thread::yield();
    return solve->describe();
  }

  StagedSolver stage;
  SceneStore scenes;
  std::string scene = scenes.add(squares(2), "")->facts.name();
  SolveStore solves{options_for(stage), scenes};
};

TEST_F(SolveStoreTest, SolveRunsUntilTheSolverReturns) {
  const auto solve = create();
  EXPECT_EQ(solve->describe().state(), v1::Solve::RUNNING);
  EXPECT_FALSE(solve->describe().has_last_step());
  Step step;
  step.shots = 3;
  stage.log().publish({}, step);
  EXPECT_EQ(solve->describe().last_step().shots(), 3u);
  stage.finish();
  EXPECT_EQ(ended(solve).state(), v1::Solve::SUCCEEDED);
  EXPECT_EQ(ended(solve).end_reason(), text(StopReason::tolerance));
  EXPECT_TRUE(ended(solve).has_end_time());
}

TEST_F(SolveStoreTest, CancelledSolveStaysReadable) {
  const auto solve = create();
  stage.log().publish(std::vector<LeafValue>{{PatchId::root(0), {1, 2, 3}}}, {});
  solves.cancel(solve->name);
  EXPECT_EQ(ended(solve).state(), v1::Solve::CANCELLED);
  EXPECT_EQ(solves.find(solve->name)->log()->leaves().size(), 1u);
  EXPECT_EQ(ended(solves.cancel(solve->name)).state(), v1::Solve::CANCELLED) << "cancelling again changes nothing";
}

TEST_F(SolveStoreTest, SolverThatThrowsFailsTheSolveAndNotTheServer) {
  const auto solve = create();
  stage.fail("no rays today");
  EXPECT_EQ(ended(solve).state(), v1::Solve::FAILED);
  EXPECT_EQ(ended(solve).end_reason(), "no rays today");
  solve->log()->wait_beyond(solve->log()->head());  // returns, as the log is closed though the solver did not close it
}

TEST_F(SolveStoreTest, OnlySoManyRunAtATimeAndOnlySoManyWait) {
  for (const auto state : {v1::Solve::RUNNING, v1::Solve::RUNNING, v1::Solve::QUEUED, v1::Solve::QUEUED})
    EXPECT_EQ(create()->describe().state(), state);
  EXPECT_EQ(refusal_of(grpc::RESOURCE_EXHAUSTED, [&] { create(); }), "2 solves are waiting, as many as this server allows");
}

TEST_F(SolveStoreTest, WaitingSolvesStartByPriorityThenAge) {
  const auto first = create(), second = create();
  v1::SolveSpec low, high;
  low.set_priority(v1::PRIORITY_LOW);
  high.set_priority(v1::PRIORITY_HIGH);
  const auto third = solves.create(scenes.use(scene), low), fourth = solves.create(scenes.use(scene), high);
  solves.cancel(first->name);
  while (fourth->describe().state() == v1::Solve::QUEUED) std::this_thread::yield();
  EXPECT_EQ(third->describe().state(), v1::Solve::QUEUED);
  solves.cancel(second->name);
  while (third->describe().state() == v1::Solve::QUEUED) std::this_thread::yield();
}

TEST_F(SolveStoreTest, PausedSolveGoesOnFromWhereItWas) {
  const auto solve = create();
  EXPECT_EQ(stage.resumed_from(), 0u);
  stage.log().publish(std::vector<LeafValue>{{PatchId::root(0), {1, 2, 3}}}, {});
  solves.pause(solve->name);
  while (solve->describe().state() != v1::Solve::PAUSED) std::this_thread::yield();
  EXPECT_FALSE(solve->log()->closed());
  solves.resume(solve->name);
  EXPECT_EQ(stage.resumed_from(), sizeof(std::uint32_t));
  EXPECT_EQ(solve->describe().state(), v1::Solve::RUNNING);
  EXPECT_EQ(stage.log().head(), 1u);
  stage.finish();
  EXPECT_EQ(ended(solve).state(), v1::Solve::SUCCEEDED);
  EXPECT_EQ(refusal_of(grpc::FAILED_PRECONDITION, [&] { solves.pause(solve->name); }), solve->name + " has ended");
}

TEST_F(SolveStoreTest, PausedSolveCanBeCancelledAndLeavesItsPlaceToOthers) {
  const auto first = create(), second = create(), third = create();
  solves.pause(third->name);
  EXPECT_EQ(third->describe().state(), v1::Solve::PAUSED) << "it had not begun";
  solves.pause(first->name);
  while (first->describe().state() != v1::Solve::PAUSED) std::this_thread::yield();
  solves.resume(third->name);
  while (third->describe().state() != v1::Solve::RUNNING) std::this_thread::yield();
  solves.cancel(first->name);
  EXPECT_EQ(first->describe().state(), v1::Solve::CANCELLED);
  EXPECT_TRUE(first->log()->closed());
}

TEST_F(SolveStoreTest, CancellingASolveThatIsJustBeingParkedIsNotForgotten) {
  for (int n = 0; n < 20; ++n) {
    const auto solve = create();
    stage.log();
    solves.pause(solve->name);
    solves.cancel(solve->name);
    EXPECT_EQ(ended(solve).state(), v1::Solve::CANCELLED);
  }
}

/// Tests with a solver that ends only when the test says so.
class KeptSolveTest : public testing::Test {
 protected:
  ~KeptSolveTest() override {
    solves.shut_down();
    std::filesystem::remove_all(directory);
  }
  SolveStoreOptions options() {
    SolveStoreOptions made;
    made.solver = [this](auto&, auto&, auto&, SolutionLog&, const SolveControl& control) {
      may_stop.acquire();
      SolveOutcome outcome;
      outcome.reason = control.stop.stop_requested() ? StopReason::cancelled : StopReason::parked;
      return outcome;
    };
    made.keeping.archive = &archive;
    return made;
  }
  v1::Solve kept() { return archive.solves().at(0).facts; }

  const std::filesystem::path directory = std::filesystem::temp_directory_path() / ("alvor_kept_" + std::to_string(getpid()));
  Archive archive{directory};
  std::binary_semaphore may_stop{0};
  SceneStore scenes{&archive, {}};
  SolveStore solves{options(), scenes};
};

TEST_F(KeptSolveTest, WhatItShallDoIsKeptBeforeItIsDone) {
  const auto solve = solves.create(scenes.use(scenes.add(squares(2), "")->facts.name()), {}, {});
  while (kept().state() != v1::Solve::RUNNING) std::this_thread::yield();
  solves.pause(solve->name);
  EXPECT_EQ(kept().state(), v1::Solve::PAUSED);
  solves.resume(solve->name);
  EXPECT_EQ(kept().state(), v1::Solve::RUNNING);
  EXPECT_FALSE(kept().has_end_time());
  solves.pause(solve->name);
  solves.cancel(solve->name);
  EXPECT_EQ(kept().state(), v1::Solve::CANCELLED);
  EXPECT_TRUE(kept().has_end_time());
  EXPECT_EQ(kept().end_reason(), "cancelled");
  EXPECT_EQ(solve->state(), v1::Solve::RUNNING) << "others are told once it has stopped";
  may_stop.release();
  while (!solve->ended()) std::this_thread::yield();
  EXPECT_EQ(kept().state(), v1::Solve::CANCELLED);
}

TEST_F(SolveStoreTest, SameRequestMakesOneSolve) {
  const auto solve = solves.create(scenes.use(scene), {}, {"", "once"});
  EXPECT_EQ(solves.create(scenes.use(scene), {}, {"", "once"}), solve);
  v1::SolveSpec other;
  other.set_tolerance(0.1);
  EXPECT_EQ(refusal_of(grpc::INVALID_ARGUMENT,
                       [&] {
                         solves.create(scenes.use(scene), other, {"", "once"});
                       }),
            "request_id: 'once' was used for another request");
  EXPECT_EQ(refusal_of(grpc::INVALID_ARGUMENT,
                       [&] {
                         solves.create(scenes.use(scene), {}, {"", "a b"});
                       }),
            "request_id: must be 1 to 64 printable ASCII characters");
}

TEST_F(SolveStoreTest, TenantsSeeAndCountTheirOwn) {
  const std::string hers = scenes.add(squares(1), "", {"ada", ""})->facts.name();
  EXPECT_EQ(refusal_of(grpc::NOT_FOUND, [&] { scenes.use(hers, "bob"); }), hers + " does not exist");
  const auto solve = solves.create(scenes.use(hers, "ada"), {}, {"ada", ""});
  EXPECT_EQ(refusal_of(grpc::NOT_FOUND, [&] { solves.cancel(solve->name, "bob"); }), solve->name + " does not exist");
  EXPECT_TRUE(solves.list("scenes/-", {}, "bob").items.empty());
  EXPECT_EQ(solves.list("scenes/-", {}, "ada").items.size(), 1u);
}

class SolveQuotaTest : public testing::Test {
 protected:
  SolveStore solves_with(const Quota& quota) {
    SolveStoreOptions options;
    options.quota = quota;
    options.solver = stage.solver();
    return {options, scenes};
  }
  /// Creates one more solve. Returns how it is refused, or "" if it is not.
  std::string refusal(SolveStore& solves, const v1::SolveSpec& spec = {}) {
    return refusal_of(grpc::RESOURCE_EXHAUSTED, [&] { solves.create(scenes.use(scene), spec); });
  }
  StagedSolver stage;
  SceneStore scenes;
  const std::string scene = scenes.add(squares(2), "")->facts.name();
};

TEST_F(SolveQuotaTest, ThoseThatHaveEndedAreCountedToo) {
  SolveStore solves = solves_with({.ended_solves = 1});
  const auto solve = solves.create(scenes.use(scene), {});
  stage.finish();
  while (!solve->ended()) std::this_thread::yield();
  EXPECT_EQ(refusal(solves), "solves: 1 that have ended are kept, as many as are allowed: delete some");
  solves.remove(solve->name);
  EXPECT_EQ(refusal(solves), "");
}

TEST_F(SolveQuotaTest, EndsWhatATenantMayStart) {
  SolveStore solves = solves_with({.solves = 2, .leaves = 1000});
  v1::SolveSpec spec;
  spec.set_max_elements(600);
  EXPECT_EQ(refusal(solves, spec), "");
  EXPECT_EQ(refusal(solves, spec), "solve.spec.max_elements: with the other solves that have not ended 1200, 1000 are allowed");
  spec.set_max_elements(400);
  EXPECT_EQ(refusal(solves, spec), "");
  EXPECT_EQ(refusal(solves, spec), "solves: 2 have not ended, as many as are allowed");
}

TEST_F(SolveStoreTest, RunningSolveCannotBeDeletedAndItsSceneNeither) {
  const auto solve = create();
  EXPECT_EQ(refusal_of(grpc::FAILED_PRECONDITION, [&] { solves.remove(solve->name); }),
            solve->name + " has not ended: cancel it first");
  stage.finish();
  ended(solve);
  EXPECT_EQ(refusal_of(grpc::FAILED_PRECONDITION, [&] { scenes.remove(scene); }), scene + " has solves: delete them first");
  solves.remove(solve->name);
  scenes.remove(scene);
  EXPECT_EQ(refusal_of(grpc::NOT_FOUND, [&] { solves.find(solve->name); }), solve->name + " does not exist");
}

TEST_F(SolveStoreTest, ShutDownCancelsAndRefusesWhatComesLater) {
  const auto solve = create();
  stage.log();
  solves.shut_down();
  EXPECT_EQ(solve->describe().state(), v1::Solve::CANCELLED);
  EXPECT_EQ(refusal_of(grpc::UNAVAILABLE, [&] { create(); }), "the server is stopping");
}

TEST_F(SolveStoreTest, ListsOneSceneOrAll) {
  const std::string other = scenes.add(squares(1), "")->facts.name();
  const auto first = create();
  const auto second = solves.create(scenes.use(other), {});
  EXPECT_EQ(solves.list(scene, {}).items.size(), 1u);
  const auto all = solves.list("scenes/-", {}).items;
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0]->name, second->name);
}

TEST(SolveSpec, ZeroMeansTheDefault) {
  const SolveOptions options = options_of({}, {}), defaults;
  EXPECT_EQ(options.tolerance, defaults.tolerance);
  EXPECT_EQ(options.max_depth, defaults.max_depth);
  EXPECT_EQ(options.max_leaves, defaults.max_leaves);
  EXPECT_EQ(options.time_limit_s, defaults.time_limit_s);
  EXPECT_EQ(options.seed, defaults.seed);
  v1::SolveSpec zeros;
  zeros.set_max_depth(0);
  zeros.set_seed(0);
  EXPECT_EQ(options_of(zeros, {}).max_depth, 0);
  EXPECT_EQ(options_of(zeros, {}).seed, 0u);
}

TEST(SolveSpec, WhatIsAskedIsEffective) {
  v1::SolveSpec asked;
  asked.set_tolerance(0.5);
  asked.set_max_depth(0);
  asked.set_max_elements(7);
  asked.set_min_edge_meters(0.1);
  asked.mutable_time_limit()->set_seconds(2);
  asked.set_threads(1);
  asked.set_seed(0);
  asked.set_strategy(v1::STRATEGY_SHOOT);
  asked.set_form_factors(v1::FORM_FACTORS_HEMICUBE);
  asked.mutable_step_pause()->set_nanos(1000);
  asked.set_priority(v1::PRIORITY_LOW);
  EXPECT_EQ(effective_spec(asked, options_of(asked, {})).ShortDebugString(), asked.ShortDebugString());
}

TEST_F(KeptDirectoryTest, EndedSolveTellsTheLimitsThatItHad) {
  Archive archive{directory};
  SceneStore scenes{&archive};
  SolveStoreOptions options;
  options.keeping.archive = &archive;
  options.solver = [](auto&&...) { return SolveOutcome(); };
  options.limits.leaves = 1000;
  const auto told = [](const SolveStore& solves) { return solves.all().at(0)->describe().effective_spec().max_elements(); };
  {
    SolveStore solves{options, scenes};
    const auto solve = solves.create(scenes.use(scenes.add(squares(2), "")->facts.name()), {});
    while (!solve->ended()) std::this_thread::yield();
    EXPECT_EQ(told(solves), 1000u);
  }
  options.limits.leaves = 500;
  EXPECT_EQ(told(SolveStore(options, scenes)), 1000u);
}

TEST(SolveSpec, FieldsOutsideTheirRangeAreRefusedByName) {
  struct Case {
    const char* refusal;
    void (*spoil)(v1::SolveSpec&);
  };
  const Case cases[] = {
      {"solve.spec.tolerance: 2 is outside (0, 1]", [](auto& s) { s.set_tolerance(2); }},
      {"solve.spec.tolerance: -0.5 is outside (0, 1]", [](auto& s) { s.set_tolerance(-0.5); }},
      {"solve.spec.tolerance: nan is outside (0, 1]", [](auto& s) { s.set_tolerance(NAN); }},
      {"solve.spec.max_depth: 16 is outside [0, 15]", [](auto& s) { s.set_max_depth(16); }},
      {"solve.spec.max_elements: 101 is more than 100, the limit of this server", [](auto& s) { s.set_max_elements(101); }},
      {"solve.spec.min_edge_meters: -1 is not a finite length >= 0", [](auto& s) { s.set_min_edge_meters(-1); }},
      {"solve.spec.step_pause: 61 s is more than a minute", [](auto& s) { s.mutable_step_pause()->set_seconds(61); }},
      {"solve.spec.time_limit: -1 s is not a duration >= 0", [](auto& s) { s.mutable_time_limit()->set_seconds(-1); }},
      {"solve.spec.threads: 2 is outside [0, 1]", [](auto& s) { s.set_threads(2); }},
      {"solve.spec.strategy: 99 is not known to this server", [](auto& s) { s.set_strategy(static_cast<v1::Strategy>(99)); }},
  };
  for (const Case& spoilt : cases) {
    v1::SolveSpec spec;
    spoilt.spoil(spec);
    EXPECT_EQ(refusal_of(grpc::INVALID_ARGUMENT, [&] { options_of(spec, {.leaves = 100, .threads = 1}); }), spoilt.refusal);
  }
}

}  // namespace
}  // namespace alvor
