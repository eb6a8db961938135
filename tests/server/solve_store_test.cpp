#include "server/solves/solve_store.h"

#include "server/archive/record_codec.h"
#include "tests/server/kept/kept_directory.h"
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
  static SolveRecord ended(const std::shared_ptr<StoredSolve>& solve) {
    // The state is final before the log's listeners are woken for the last time, but those who wait for the log may be woken
    // earlier.
    while (!solve->ended()) std::this_thread::yield();
    return solve->describe();
  }

  StagedSolver stage;
  SceneStore scenes;
  std::string scene = scenes.add(squares(2), "")->facts.name;
  SolveStore solves{options_for(stage), scenes};
};

TEST_F(SolveStoreTest, SolveRunsUntilTheSolverReturns) {
  const auto solve = create();
  EXPECT_EQ(solve->describe().status, SolveStatus::running);
  EXPECT_FALSE(solve->describe().last_step.has_value());
  Step step;
  step.shots = 3;
  stage.log().publish({}, step);
  EXPECT_EQ(solve->describe().last_step->shots, 3u);
  stage.finish();
  EXPECT_EQ(ended(solve).status, SolveStatus::succeeded);
  EXPECT_EQ(ended(solve).end_reason, text(StopReason::tolerance));
  EXPECT_TRUE(ended(solve).end_time.has_value());
}

TEST_F(SolveStoreTest, CancelledSolveStaysReadable) {
  const auto solve = create();
  stage.log().publish(std::vector<LeafValue>{{PatchId::root(0), {1, 2, 3}}}, {});
  solves.cancel(solve->name);
  EXPECT_EQ(ended(solve).status, SolveStatus::cancelled);
  EXPECT_EQ(solves.find(solve->name)->log()->leaves().size(), 1u);
  EXPECT_EQ(ended(solves.cancel(solve->name)).status, SolveStatus::cancelled) << "cancelling again changes nothing";
}

TEST_F(SolveStoreTest, SolverThatThrowsFailsTheSolveAndNotTheServer) {
  const auto solve = create();
  stage.fail("no rays today");
  EXPECT_EQ(ended(solve).status, SolveStatus::failed);
  EXPECT_EQ(ended(solve).end_reason, "no rays today");
  solve->log()->wait_beyond(solve->log()->head());  // returns, as the log is closed though the solver did not close it
}

TEST_F(SolveStoreTest, OnlySoManyRunAtATimeAndOnlySoManyWait) {
  for (const auto status : {SolveStatus::running, SolveStatus::running, SolveStatus::queued, SolveStatus::queued})
    EXPECT_EQ(create()->describe().status, status);
  EXPECT_EQ(refusal_of(grpc::RESOURCE_EXHAUSTED, [&] { create(); }), "2 solves are waiting, as many as this server allows");
}

TEST_F(SolveStoreTest, WaitingSolvesStartByPriorityThenAge) {
  const auto first = create(), second = create();
  const auto third = solves.create(scenes.use(scene), {.priority = SolvePriority::low});
  const auto fourth = solves.create(scenes.use(scene), {.priority = SolvePriority::high});
  solves.cancel(first->name);
  while (fourth->describe().status == SolveStatus::queued) std::this_thread::yield();
  EXPECT_EQ(third->describe().status, SolveStatus::queued);
  solves.cancel(second->name);
  while (third->describe().status == SolveStatus::queued) std::this_thread::yield();
}

TEST_F(SolveStoreTest, PausedSolveGoesOnFromWhereItWas) {
  const auto solve = create();
  EXPECT_EQ(stage.resumed_from(), 0u);
  stage.log().publish(std::vector<LeafValue>{{PatchId::root(0), {1, 2, 3}}}, {});
  solves.pause(solve->name);
  while (solve->describe().status != SolveStatus::paused) std::this_thread::yield();
  EXPECT_FALSE(solve->log()->closed());
  solves.resume(solve->name);
  EXPECT_EQ(stage.resumed_from(), sizeof(std::uint32_t));
  EXPECT_EQ(solve->describe().status, SolveStatus::running);
  EXPECT_EQ(stage.log().head(), 1u);
  stage.finish();
  EXPECT_EQ(ended(solve).status, SolveStatus::succeeded);
  EXPECT_EQ(refusal_of(grpc::FAILED_PRECONDITION, [&] { solves.pause(solve->name); }), solve->name + " has ended");
}

TEST_F(SolveStoreTest, PausedSolveCanBeCancelledAndLeavesItsPlaceToOthers) {
  const auto first = create(), second = create(), third = create();
  solves.pause(third->name);
  EXPECT_EQ(third->describe().status, SolveStatus::paused) << "it had not begun";
  solves.pause(first->name);
  while (first->describe().status != SolveStatus::paused) std::this_thread::yield();
  solves.resume(third->name);
  while (third->describe().status != SolveStatus::running) std::this_thread::yield();
  solves.cancel(first->name);
  EXPECT_EQ(first->describe().status, SolveStatus::cancelled);
  EXPECT_TRUE(first->log()->closed());
}

TEST_F(SolveStoreTest, CancellingASolveThatIsJustBeingParkedIsNotForgotten) {
  for (int n = 0; n < 20; ++n) {
    const auto solve = create();
    stage.log();
    solves.pause(solve->name);
    solves.cancel(solve->name);
    EXPECT_EQ(ended(solve).status, SolveStatus::cancelled);
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
  SolveRecord kept() { return archive.solves().at(0).facts; }

  const std::filesystem::path directory = std::filesystem::temp_directory_path() / ("alvor_kept_" + std::to_string(getpid()));
  Archive archive{directory};
  std::binary_semaphore may_stop{0};
  SceneStore scenes{&archive, {}};
  SolveStore solves{options(), scenes};
};

TEST_F(KeptSolveTest, WhatItShallDoIsKeptBeforeItIsDone) {
  const auto solve = solves.create(scenes.use(scenes.add(squares(2), "")->facts.name), {}, {});
  while (kept().status != SolveStatus::running) std::this_thread::yield();
  solves.pause(solve->name);
  EXPECT_EQ(kept().status, SolveStatus::paused);
  solves.resume(solve->name);
  EXPECT_EQ(kept().status, SolveStatus::running);
  EXPECT_FALSE(kept().end_time.has_value());
  solves.pause(solve->name);
  solves.cancel(solve->name);
  EXPECT_EQ(kept().status, SolveStatus::cancelled);
  EXPECT_TRUE(kept().end_time.has_value());
  EXPECT_EQ(kept().end_reason, "cancelled");
  EXPECT_EQ(solve->status(), SolveStatus::running) << "others are told once it has stopped";
  may_stop.release();
  while (!solve->ended()) std::this_thread::yield();
  EXPECT_EQ(kept().status, SolveStatus::cancelled);
}

TEST_F(SolveStoreTest, SameRequestMakesOneSolve) {
  const auto solve = solves.create(scenes.use(scene), {}, {"", "once"});
  EXPECT_EQ(solves.create(scenes.use(scene), {}, {"", "once"}), solve);
  EXPECT_EQ(refusal_of(grpc::INVALID_ARGUMENT,
                       [&] {
                         solves.create(scenes.use(scene), {.tolerance = 0.1}, {"", "once"});
                       }),
            "request_id: 'once' was used for another request");
  EXPECT_EQ(refusal_of(grpc::INVALID_ARGUMENT,
                       [&] {
                         solves.create(scenes.use(scene), {}, {"", "a b"});
                       }),
            "request_id: must be 1 to 64 printable ASCII characters");
}

TEST_F(SolveStoreTest, TenantsSeeAndCountTheirOwn) {
  const std::string hers = scenes.add(squares(1), "", {"ada", ""})->facts.name;
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
  std::string refusal(SolveStore& solves, const SolveSpec& spec = {}) {
    return refusal_of(grpc::RESOURCE_EXHAUSTED, [&] { solves.create(scenes.use(scene), spec); });
  }
  StagedSolver stage;
  SceneStore scenes;
  const std::string scene = scenes.add(squares(2), "")->facts.name;
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
  SolveSpec spec{.max_elements = 600};
  EXPECT_EQ(refusal(solves, spec), "");
  EXPECT_EQ(refusal(solves, spec), "solve.spec.max_elements: with the other solves that have not ended 1200, 1000 are allowed");
  spec.max_elements = 400;
  EXPECT_EQ(refusal(solves, spec), "");
  EXPECT_EQ(refusal(solves, spec), "solves: 2 have not ended, as many as are allowed");
}

TEST_F(SolveStoreTest, RunningSolveCannotBeDeletedAndItsSceneNeither) {
  const auto solve = create();
  EXPECT_EQ(refusal_of(grpc::FAILED_PRECONDITION, [&] { solves.remove(solve->name); }),
            solve->name + " has not ended: cancel it first");
  stage.finish();
  ended(solve);
  EXPECT_EQ(refusal_of(grpc::FAILED_PRECONDITION, [&] { scenes.remove(scene); }),
            scene + " has solves, or was added to one: delete these first");
  solves.remove(solve->name);
  scenes.remove(scene);
  EXPECT_EQ(refusal_of(grpc::NOT_FOUND, [&] { solves.find(solve->name); }), solve->name + " does not exist");
}

TEST_F(SolveStoreTest, ShutDownCancelsAndRefusesWhatComesLater) {
  const auto solve = create();
  stage.log();
  solves.shut_down();
  EXPECT_EQ(solve->describe().status, SolveStatus::cancelled);
  EXPECT_EQ(refusal_of(grpc::UNAVAILABLE, [&] { create(); }), "the server is stopping");
}

TEST_F(SolveStoreTest, ListsOneSceneOrAll) {
  const std::string other = scenes.add(squares(1), "")->facts.name;
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
  const SolveSpec zeros{.max_depth = 0, .seed = 0};
  EXPECT_EQ(options_of(zeros, {}).max_depth, 0);
  EXPECT_EQ(options_of(zeros, {}).seed, 0u);
}

TEST(SolveSpec, NamedObjectsNeedNotBeWithinTheToleranceEverywhere) {
  EXPECT_EQ(options_of({}, {}).area_share, 1);
  EXPECT_EQ(options_of({.objects = {"table"}}, {}).area_share, 0.95);
  EXPECT_EQ(options_of({.area_share = 1, .objects = {"table"}}, {}).area_share, 1);
}

TEST(SolveSpec, WhatIsAskedIsEffective) {
  const SolveSpec asked{.tolerance = 0.5,
                        .area_share = 0.9,
                        .objects = {"table", "chair"},
                        .max_depth = 0,
                        .max_elements = 7,
                        .min_edge_m = 0.1,
                        .time_limit_s = 2,
                        .threads = 1,
                        .seed = 0,
                        .strategy = Strategy::shoot,
                        .form_factors = FormFactorMethod::hemicube,
                        .step_pause_s = 1e-6,
                        .priority = SolvePriority::low};
  EXPECT_EQ(effective_spec(asked, options_of(asked, {})), asked);
}

TEST_F(KeptDirectoryTest, EndedSolveTellsTheLimitsThatItHad) {
  Archive archive{directory};
  SceneStore scenes{&archive};
  SolveStoreOptions options;
  options.keeping.archive = &archive;
  options.solver = [](auto&&...) { return SolveOutcome(); };
  options.limits.leaves = 1000;
  const auto told = [](const SolveStore& solves) { return solves.all().at(0)->describe().effective_spec->max_elements; };
  {
    SolveStore solves{options, scenes};
    const auto solve = solves.create(scenes.use(scenes.add(squares(2), "")->facts.name), {});
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
      {"solve.spec.area_share: 1.5 is outside (0, 1]", [](auto& s) { s.set_area_share(1.5); }},
      {"solve.spec.area_share: nan is outside (0, 1]", [](auto& s) { s.set_area_share(NAN); }},
      {"solve.spec.objects: 1001 are more than 1000",
       [](auto& s) {
         for (int n = 0; n <= 1000; ++n) s.add_objects("x");
       }},
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
    EXPECT_EQ(refusal_of(grpc::INVALID_ARGUMENT, [&] { options_of(decode(spec), {.leaves = 100, .threads = 1}); }),
              spoilt.refusal);
  }
}

}  // namespace
}  // namespace alvor
