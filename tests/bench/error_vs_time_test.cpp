// Tests of the statistics of measurements, and of the programs with which the solver is compared.

#include "bench/error_vs_time/contest/figures.h"
#include "bench/error_vs_time/contest/fixed_mesh_shooting.h"
#include "bench/error_vs_time/contest/peak_memory.h"
#include "bench/error_vs_time/contest/truth.h"
#include "bench/error_vs_time/contest/truth_file.h"
#include "bench/error_vs_time/page/comparisons.h"
#include "bench/error_vs_time/page/limits.h"
#include "bench/error_vs_time/page/page_sections.h"
#include "bench/error_vs_time/page/targets.h"
#include "import/apart/scene_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace alvor::bench {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

MeasuredRun run_of(Contender contender, double setting, double cpu_s, double nrmse) {
  MeasuredRun run{"room", contender, setting};
  run.cpu_s = run.wall_s = cpu_s, run.nrmse = {nrmse, nrmse, nrmse}, run.estimated = 2 * nrmse;
  return run;
}

MeasuredRun on_two_threads(double setting, double wall_s) {
  MeasuredRun run = run_of(Contender::alvor, setting, wall_s, 0.01);
  run.threads = 2;
  return run;
}

TEST(Spread, IsTheMiddleAndTheEnds) {
  const Spread odd = spread_of({3, 1, 10}), even = spread_of({4, 1, 2, 10});
  EXPECT_EQ(odd.median, 3);
  EXPECT_EQ(odd.low, 1);
  EXPECT_EQ(odd.high, 10);
  EXPECT_EQ(even.median, 3);
  EXPECT_EQ(spread_of({7}).median, 7);
}

TEST(CostToReach, IsInterpolatedAlongAPowerLaw) {
  const std::vector<CurvePoint> curve{{100, 0.01}, {1, 0.1}};  // error ~ cost^-1/2, in any order
  const auto reached = cost_to_reach(curve, 0.02);
  ASSERT_TRUE(reached);
  EXPECT_NEAR(reached->cost, 25, 1e-9);
  EXPECT_FALSE(reached->at_most);
}

TEST(CostToReach, IsABoundWhereTheCheapestIsBetter) {
  const std::vector<CurvePoint> curve{{1, 0.01}, {4, 0.005}};
  const auto reached = cost_to_reach(curve, 0.02);
  ASSERT_TRUE(reached);
  EXPECT_EQ(reached->cost, 1);
  EXPECT_TRUE(reached->at_most);
}

TEST(CostToReach, IsNothingWhereNoneIsGoodEnough) {
  EXPECT_FALSE(cost_to_reach(std::vector<CurvePoint>{{1, 0.1}, {4, 0.05}}, 0.02));
  EXPECT_FALSE(cost_to_reach({}, 0.02));
}

TEST(CostToReach, TakesAnErrorBelowTheNoiseAsReachedThere) {
  EXPECT_EQ(cost_to_reach(std::vector<CurvePoint>{{1, 0.1}, {4, 0}}, 0.02)->cost, 4);
}

TEST(SamplingCost, GrowsWithTheSquareOfTheAccuracy) { EXPECT_DOUBLE_EQ(sampling_cost_to_reach({2, 0.03}, 0.01), 18); }

TEST(Verdict, NeedsTheCostWithinTheLimit) {
  EXPECT_EQ(at_most(Reached{0.9}, 1), Verdict::met);
  EXPECT_EQ(at_most(Reached{1.1}, 1), Verdict::missed);
  EXPECT_EQ(at_most(std::nullopt, 1), Verdict::missed);
}

TEST(Verdict, SaysWhereTheIntervalDoesNotTell) {
  EXPECT_EQ(keeps({0.015, 0.012, 0.018}, 0.02).verdict, Verdict::met);
  EXPECT_EQ(keeps({0.015, 0.012, 0.018}, 0.02).note, "");
  EXPECT_NE(keeps({0.015, 0.010, 0.021}, 0.02).note, "");
  EXPECT_EQ(keeps({0.025, 0.015, 0.035}, 0.02).verdict, Verdict::missed);
}

TEST(Verdict, OnTheSlopeIsOfTheFirstAndTheLastPoint) {
  const std::vector<CurvePoint> steep{{1, 0.1}, {2, 0.08}, {10, 0.01}}, flat{{1, 0.1}, {100, 0.01}};
  EXPECT_EQ(judge_slope(steep).verdict, Verdict::met);
  EXPECT_EQ(judge_slope(flat).verdict, Verdict::missed);
  EXPECT_EQ(judge_slope({}).verdict, Verdict::not_measured);
}

TEST(Verdict, OnEstimatesNeedsNearlyAllCloseAndNoneFar) {
  std::vector<double> ratios(19, 1.2);
  ratios.push_back(0.55);
  EXPECT_EQ(judge_estimates("of a test", ratios).verdict, Verdict::met);
  ratios.push_back(1.8);  // now 2 of 21 are not close
  EXPECT_EQ(judge_estimates("of a test", ratios).verdict, Verdict::missed);
  EXPECT_EQ(judge_estimates("of a test", std::vector<double>(100, 1.0)).verdict, Verdict::met);
  std::vector<double> with_one_far(100, 1.0);
  with_one_far.front() = 2.1;
  EXPECT_EQ(judge_estimates("of a test", with_one_far).verdict, Verdict::missed);
}

TEST(Verdict, OnMemoryNeedsLessThanHalfAGigabyte) {
  EXPECT_EQ(judge_memory(499'000'000).verdict, Verdict::met);
  EXPECT_EQ(judge_memory(500'000'000).verdict, Verdict::missed);
  EXPECT_EQ(judge_memory(0).verdict, Verdict::not_measured);
}

TEST(PeakMemory, IsThatOfTheProgram) {
  constexpr std::uint64_t held = 64 << 20;
  const std::string command = "x=$(head -c " + std::to_string(held) + " /dev/zero | tr '\\0' a)";
  ASSERT_LT(peak_memory_of("/bin/sh", {"-c", "exit 0"}), held) << "this process holds too much itself";
  EXPECT_GT(peak_memory_of("/bin/sh", {"-c", command}), held);
  EXPECT_THROW(peak_memory_of("/bin/sh", {"-c", "exit 3"}), std::runtime_error);
  EXPECT_THROW(peak_memory_of("/nowhere/at all", {}), std::runtime_error);
}

TEST(Verdict, OnToldErrorsBoundsTheShareFromBothSides) {
  EXPECT_EQ(judge_told_errors(std::vector{0.9, 0.95, 0.99}).verdict, Verdict::met);
  EXPECT_EQ(judge_told_errors(std::vector{0.85, 0.95}).verdict, Verdict::missed);
  EXPECT_EQ(judge_told_errors(std::vector{0.95, 1.0}).verdict, Verdict::missed);
  EXPECT_EQ(judge_rises(4, 100).verdict, Verdict::met);
  EXPECT_EQ(judge_rises(5, 100).verdict, Verdict::missed);
  EXPECT_EQ(judge_rises(0, 0).verdict, Verdict::not_measured);
}

TEST(Verdict, IsNotGivenOnWhatWasNotMeasured) {
  for (const Judgement& judgement : judge({}, 0.5, 1.9)) EXPECT_EQ(judgement.verdict, Verdict::not_measured) << judgement.aim;
}

TEST(Verdict, IsAMissWhereALooserToleranceRanOutOfTime) {
  std::vector<MeasuredRun> runs{run_of(Contender::alvor, 0.05, 1, 0.04), run_of(Contender::alvor, 0.03, 20, 0.01)};
  EXPECT_EQ(keeps_tolerance(grouped(runs), 0.02).verdict, Verdict::not_measured);
  runs.back().is_done = false;
  EXPECT_EQ(keeps_tolerance(grouped(runs), 0.02).verdict, Verdict::missed);
  runs.back().setting = 0.02;  // the error is small by chance; the run did not report it
  EXPECT_EQ(keeps_tolerance(grouped(runs), 0.02).verdict, Verdict::missed);
}

TEST(Verdict, OnThreadsIsNotGivenOnABusyMachine) {
  EXPECT_EQ(judge_thread_gain(10, 5, 1.95).verdict, Verdict::met);
  EXPECT_EQ(judge_thread_gain(10, 7, 1.95).verdict, Verdict::missed);
  EXPECT_EQ(judge_thread_gain(10, 9.8, 1.02).verdict, Verdict::not_measured);
  EXPECT_NE(judge_thread_gain(10, 9.8, 1.02).note, "");
}

TEST(Comparison, TakesPathTracingToTenThousandPoints) {
  const std::vector<MeasuredRun> runs{run_of(Contender::alvor, 0.02, 0.1, 0.02), run_of(Contender::alvor, 0.01, 0.4, 0.005),
                                      run_of(Contender::path_tracing, 64, 1, 0.04)};
  const auto comparison = with_path_tracing(grouped(runs), 2000, 0.01);
  ASSERT_TRUE(comparison && comparison->ours);
  EXPECT_TRUE(comparison->is_extrapolated);
  EXPECT_NEAR(comparison->theirs_s, 16 * 5, 1e-9);
  EXPECT_NEAR(comparison->times_faster(), 80 / 0.2, 1e-9);
}

TEST(Comparison, TakesTheBestOfTheFixedMeshes) {
  const std::vector<MeasuredRun> runs{run_of(Contender::alvor, 0.1, 0.1, 0.02), run_of(Contender::fixed_mesh, 8, 1, 0.05),
                                      run_of(Contender::fixed_mesh, 16, 9, 0.03)};
  const auto comparison = with_fixed_mesh(grouped(runs));
  ASSERT_TRUE(comparison && comparison->ours);
  EXPECT_EQ(comparison->error, 0.03);
  EXPECT_TRUE(comparison->ours->at_most);
  EXPECT_NEAR(comparison->times_faster(), 90, 1e-9);
}

TEST(Comparison, OfThreadsCountsWhatBothFinished) {
  std::vector<MeasuredRun> runs{run_of(Contender::alvor, 0.1, 4, 0.1), run_of(Contender::alvor, 0.01, 8, 0.1),
                                on_two_threads(0.1, 2), on_two_threads(0.01, 7)};
  runs.back().is_done = false;
  EXPECT_DOUBLE_EQ(gain_of_two_threads(grouped(runs)).times_faster(), 2);
}

TEST(EstimateRatios, LeaveOutWhatRanOutOfTime) {
  std::vector<MeasuredRun> runs{run_of(Contender::alvor, 0.1, 1, 0.1), run_of(Contender::alvor, 0.01, 1, 0.1)};
  runs.back().is_done = false;
  EXPECT_EQ(estimate_ratios(runs), std::vector<double>{2});
}

TEST(EstimateRatios, OfStoppedRunsAreThoseThatATimeLimitEnded) {
  std::vector<MeasuredRun> runs{run_of(Contender::alvor, 0.1, 1, 0.1), run_of(Contender::until_time, 1, 1, 0.1),
                                run_of(Contender::until_time, 2, 1, 0.1), run_of(Contender::to_leaves, 1000, 1, 0.1)};
  for (MeasuredRun& run : runs) run.is_done = false;
  runs[2].is_done = true;
  EXPECT_EQ(estimate_ratios_of_stopped(runs), std::vector<double>{2});
}

SceneContest contest_of(std::vector<MeasuredRun> runs) {
  SceneContest held;
  held.settings.name = "room";
  held.runs = std::move(runs);
  held.groups = grouped(held.runs);
  return held;
}

TEST(PartsSection, ComparesSolvesAtTheToleranceAtWhichPartsAreLeftOut) {
  SceneContest held = contest_of({run_of(Contender::alvor, 0.05, 1, 0.04), run_of(Contender::alvor, 0.02, 4, 0.02),
                                  run_of(Contender::no_slabs, 0.02, 8, 0.01)});
  held.settings.parts_tolerance = 0.02;
  Measurements measured;
  measured.contests = {held};
  const std::string section = parts_section(measured);
  EXPECT_NE(section.find("| all | 2.00 % in 4.00 s; 16.0 |"), std::string::npos) << section;
  EXPECT_NE(section.find("| all but slabs | 1.00 % in 8.00 s; 8.00 |"), std::string::npos) << section;
  EXPECT_NE(section.find("| no part | - |"), std::string::npos) << section;
  measured.contests[0].settings.parts_tolerance = 0;
  EXPECT_EQ(parts_section(measured), "");
}

/// A solve by Alvor that was stopped after `limit_s` and `wall_s`.
MeasuredRun stopped_run(double limit_s, double wall_s, double error) {
  MeasuredRun run = run_of(Contender::until_time, limit_s, wall_s, error);
  run.wall_s = wall_s, run.is_done = false;
  return run;
}

TEST(Limits, OvertimeIsThreeTenthsOfASecondOrTwoPercent) {
  const std::vector kept{contest_of({stopped_run(1, 1.29, 0.1), stopped_run(100, 101.9, 0.01)})};
  EXPECT_EQ(judge_overtime(kept).verdict, Verdict::met);
  EXPECT_EQ(judge_overtime(kept).measured, "2 of 2, at most 1.90 s longer");
  EXPECT_EQ(judge_overtime(std::vector{contest_of({stopped_run(1, 1.31, 0.1)})}).verdict, Verdict::missed);
  EXPECT_EQ(judge_overtime(std::vector{contest_of({stopped_run(100, 102.1, 0.1)})}).verdict, Verdict::missed);
  EXPECT_EQ(judge_overtime({}).verdict, Verdict::not_measured);
}

TEST(Limits, MoreTimeGivesNoWorseAnswerThanNoiseExplains) {
  EXPECT_EQ(judge_more_time(std::vector{contest_of({stopped_run(1, 1, 0.1), stopped_run(2, 2, 0.105)})}).verdict, Verdict::met);
  const std::vector worse{contest_of({stopped_run(1, 1, 0.1), stopped_run(2, 2, 0.05), stopped_run(4, 4, 0.06)})};
  EXPECT_EQ(judge_more_time(worse).verdict, Verdict::missed);
  EXPECT_EQ(judge_more_time(worse).measured, "1 of 2 steps from one time limit to the next");
  EXPECT_EQ(judge_more_time({}).verdict, Verdict::not_measured);
}

TEST(Limits, ALimitToTheMeshIsComparedWithTheSameStrategyWithoutIt) {
  const auto with_rays = [](Contender contender, double setting, std::uint64_t rays) {
    MeasuredRun run = run_of(contender, setting, 1, 0.02);
    run.rays = rays;
    return run;
  };
  const MeasuredRun free = with_rays(Contender::alvor, 0.02, 1000), sorted = with_rays(Contender::sorted, 0.02, 500);
  EXPECT_EQ(judge_mesh_limits(std::vector{contest_of({free, with_rays(Contender::to_depth, 4, 1000)})}).verdict, Verdict::met);
  EXPECT_EQ(judge_mesh_limits(std::vector{contest_of({free, with_rays(Contender::to_leaves, 4, 1001)})}).verdict,
            Verdict::missed);
  const auto held = contest_of({free, sorted, with_rays(Contender::sorted_to_depth, 4, 600)});
  EXPECT_EQ(judge_mesh_limits(std::vector{held}).verdict, Verdict::missed);
  Measurements measured;
  measured.contests = {held};
  EXPECT_NE(limits_section(measured).find("| room | --strategy sorted --max-depth 4 |"), std::string::npos);
  EXPECT_EQ(judge_mesh_limits(std::vector{contest_of({with_rays(Contender::to_depth, 4, 1)})}).verdict, Verdict::not_measured);
  MeasuredRun other_seed = with_rays(Contender::alvor, 0.02, 10), endless = free;
  other_seed.seed = 2, endless.is_done = false;
  const MeasuredRun limited = with_rays(Contender::to_depth, 4, 1000);
  EXPECT_EQ(judge_mesh_limits(std::vector{contest_of({free, other_seed, limited})}).verdict, Verdict::met);
  EXPECT_EQ(judge_mesh_limits(std::vector{contest_of({other_seed, limited})}).verdict, Verdict::not_measured);
  EXPECT_EQ(judge_mesh_limits(std::vector{contest_of({endless, limited})}).verdict, Verdict::not_measured);
}

TEST(Limits, TimesThatASceneWasNotMeasuredWithStayEmpty) {
  Measurements measured;
  measured.contests = {contest_of({stopped_run(1, 1, 0.1), stopped_run(2, 2, 0.05)}), contest_of({stopped_run(2, 2, 0.25)})};
  EXPECT_NE(limits_section(measured).find("| room |  | 25.0 % ("), std::string::npos) << limits_section(measured);
}

TEST(Figures, HaveThreeDigits) {
  EXPECT_EQ(plain(0.0031416), "0.00314");
  EXPECT_EQ(plain(4567), "4567");
  EXPECT_EQ(percent(0.01234), "1.23 %");
  EXPECT_EQ(tolerance_percent(0.015), "1.5 %");
  EXPECT_EQ(percent(Spread{0.02, 0.01, 0.03}), "2.00 % (1.00 to 3.00)");
  EXPECT_EQ(compact(1'650'000), "1.65 M");
}

class CornellBox : public testing::Test {
 protected:
  Scene scene_ = read_scene_file(ALVOR_SCENES "/cornell_box.obj").scene;
  SceneSettings scene_settings_{.name = "cornell_box", .truth_points = 200, .truth_paths = 512};
  Settings settings_;
  void SetUp() override { settings_.truth_folder = testing::TempDir() + "/truth_of_" + test_name(); }
  void TearDown() override { std::filesystem::remove_all(settings_.truth_folder); }
  static std::string test_name() { return testing::UnitTest::GetInstance()->current_test_info()->name(); }
};

TEST_F(CornellBox, TruthIsKeptForTheSameQuestionOnly) {
  const Truth traced = find_truth(scene_, scene_settings_, settings_), kept = find_truth(scene_, scene_settings_, settings_);
  EXPECT_FALSE(traced.was_kept);
  EXPECT_TRUE(kept.was_kept);
  ASSERT_EQ(kept.points.size(), 200u);
  EXPECT_EQ(kept.points.back().irradiance, traced.points.back().irradiance);
  EXPECT_EQ(errors_of_itself(kept).truth_error, errors_of_itself(traced).truth_error);
  scene_.materials.front().reflectance *= 0.5;
  EXPECT_FALSE(find_truth(scene_, scene_settings_, settings_).was_kept);
}

TEST_F(CornellBox, IrradianceThatIsNoNumberIsNoSmallError) {
  const Truth truth = find_truth(scene_, scene_settings_, settings_);
  std::vector<double> estimates(truth.points.size(), 1);
  EXPECT_GT(errors_of(estimates, truth).nrmse.value, 0.1);
  estimates.front() = nan;
  EXPECT_THROW(errors_of(estimates, truth), std::runtime_error);
}

TEST_F(CornellBox, TextbookShootingGetsBetterOnFinerMeshes) {
  const BaseMesh mesh(scene_);
  const Truth truth = find_truth(scene_, scene_settings_, settings_);
  const auto error_on = [&](int cells) {
    const FixedMeshSolution solution = shoot_on_fixed_mesh(mesh, {.cells = cells});
    EXPECT_TRUE(solution.is_done);
    return errors_of(build_display_mesh(mesh, solution.leaves), truth).nrmse.value;
  };
  const double coarse = error_on(4), fine = error_on(8);
  EXPECT_LT(fine, coarse);
  EXPECT_LT(fine, 0.08);
}

// Large elements there have their centres right under small patches: without a bound on a shot's light, it would grow for ever.
TEST(FixedMesh, ConvergesAmongSmallPatches) {
  const BaseMesh mesh(read_scene_file(ALVOR_SCENES "/furnished_room.obj").scene);
  const FixedMeshSolution solution = shoot_on_fixed_mesh(mesh, {.cells = 8});
  EXPECT_TRUE(solution.is_done);
  EXPECT_TRUE(std::ranges::all_of(solution.leaves, [](const LeafValue& leaf) { return leaf.irradiance.is_finite(); }));
}

}  // namespace
}  // namespace alvor::bench
