// Tests of error statistics against a noisy truth, and of `alvor verify`.

#include "client/verify/error_field.h"
#include "tests/command_line.h"
#include "tests/scenes.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <utility>
#include <vector>

namespace alvor {
namespace {

using test::Ran;
using test::text_of;
namespace fs = std::filesystem;

/// Draws points of mean truth 1. The solution's errors have RMS `error`, and the truth's noise has standard deviation `noise`.
class NoisyPoints {
 public:
  NoisyPoints(double error, double noise) : error_(error), noise_(noise) {}

  std::vector<ComparedPoint> draw(int count) {
    std::vector<ComparedPoint> points;
    for (int n = 0; n < count; ++n) {
      const double exact = 0.5 + uniform_(random_);
      points.push_back({exact + error_ * normal_(random_), exact + noise_ * normal_(random_), variance()});
    }
    return points;
  }

 private:
  /// Returns a variance as estimated from 32 rounds: right only on average.
  double variance() {
    double sum = 0;
    for (int n = 0; n < 31; ++n) sum += std::pow(normal_(random_), 2);
    return noise_ * noise_ * sum / 31;
  }

  double error_, noise_;
  std::mt19937_64 random_{11};
  std::uniform_real_distribution<double> uniform_;
  std::normal_distribution<double> normal_;
};

TEST(ErrorStatistics, NoiseOfTheTruthIsNoError) {
  const ErrorStatistics statistics = error_statistics(NoisyPoints(0.02, 0.05).draw(200'000));
  EXPECT_NEAR(statistics.nrmse.value, 0.02, 0.001);  // would be 0.054 with the noise
  EXPECT_NEAR(statistics.truth_error, 0.05, 0.001);
  EXPECT_LE(statistics.nrmse.low, 0.02);
  EXPECT_GE(statistics.nrmse.high, 0.02);
}

TEST(ErrorStatistics, IntervalsHoldTheErrorAsOftenAsTheySay) {
  for (const auto& [error, noise] : {std::pair{0.05, 0.0}, {0.05, 0.05}, {0.02, 0.05}}) {
    NoisyPoints points(error, noise);
    constexpr int trials = 1000;
    int nrmse_held = 0, bias_held = 0;
    for (int n = 0; n < trials; ++n) {
      const ErrorStatistics statistics = error_statistics(points.draw(300));
      nrmse_held += statistics.nrmse.low <= error && error <= statistics.nrmse.high;
      bias_held += statistics.bias.low <= 0 && 0 <= statistics.bias.high;
    }
    EXPECT_NEAR(nrmse_held, 0.95 * trials, 0.03 * trials) << error << ' ' << noise;
    EXPECT_NEAR(bias_held, 0.95 * trials, 0.03 * trials) << error << ' ' << noise;
  }
}

TEST(ErrorStatistics, ExactlyKnownErrorsAreExact) {
  const std::vector<ComparedPoint> points{{1.1, 1, 0}, {2.7, 3, 0}, {0.1, 0, 0}};
  const ErrorStatistics statistics = error_statistics(points);
  EXPECT_DOUBLE_EQ(statistics.nrmse.value, std::sqrt((0.01 + 0.09 + 0.01) / 3) / (4.0 / 3));
  EXPECT_NEAR(statistics.bias.value, -0.1 / 4, 1e-15);
  EXPECT_DOUBLE_EQ(statistics.relative_rms, 0.1);  // over two points; the third has no truth
}

TEST(ErrorStatistics, LessErrorThanNoiseIsNone) {
  const std::vector<ComparedPoint> points{{1, 1.01, 1e-3}, {1, 0.99, 1e-3}};
  EXPECT_EQ(error_statistics(points).nrmse.value, 0);
  EXPECT_EQ(error_statistics({}).nrmse.high, 0);
}

TEST(ErrorStatistics, ErrorsThatAreLostInNoiseAreNotToldToBeNone) {
  constexpr double error = 0.001;
  NoisyPoints points(error, 0.05);
  int without_error = 0;
  for (int n = 0; n < 200; ++n) {
    const ErrorStatistics statistics = error_statistics(points.draw(300));
    without_error += statistics.nrmse.value == 0;
    EXPECT_GE(statistics.nrmse.high, error);
  }
  EXPECT_GT(without_error, 20);
}

TEST(ErrorStatistics, AValueThatIsNotANumberIsNoSmallError) {
  const ComparedPoint points[] = {{.solution = 1, .truth = 1},
                                  {.solution = std::numeric_limits<double>::quiet_NaN(), .truth = 1}};
  EXPECT_FALSE(error_statistics(points).nrmse.value <= 1e9);
}

TEST(ErrorStatistics, LightInTheDarkIsAnInfiniteError) {
  const std::vector<ComparedPoint> lit{{1, 0, 0}, {0, 0, 0}}, dark{{0, 0, 0}};
  EXPECT_GT(error_statistics(lit).nrmse.low, 1e300);
  EXPECT_EQ(error_statistics(dark).nrmse.value, 0);
}

/// Returns a point on a floor at y = 0. The truth of its two rounds is 1 plus and minus `noise`.
VerifiedPoint floor_point(double x, double solution, double noise = 0) {
  VerifiedPoint point{{{x, 0, 0}, {0, 1, 0}}, {}, Rgb{1, 1, 1} * solution};
  for (const double truth : {1 + noise, 1 - noise}) point.truth.add(Rgb{1, 1, 1} * truth);
  return point;
}

ErrorField field_of(std::vector<VerifiedPoint> points) {
  Verification verification;
  verification.points = std::move(points);
  verification.errors.points = verification.points.size();
  return ErrorField(verification);
}

TEST(ErrorField, FollowsThePointsAroundThatFaceTheSameWay) {
  VerifiedPoint ceiling = floor_point(-1, 5);
  ceiling.at.normal = {0, -1, 0};
  const ErrorField field = field_of({floor_point(-100, 1.1), floor_point(100, 0.8), ceiling});
  EXPECT_NEAR(field.at({-100, 0, 0}, {0, 1, 0}).error, 0.1, 0.02);
  EXPECT_NEAR(field.at({100, 0, 0}, {0, 1, 0}).error, -0.2, 0.02);
  EXPECT_NEAR(field.at({0, 0, 0}, {0, 1, 0}).error, -0.05, 1e-5);
  EXPECT_NEAR(field.at({-50, 0, 0}, {0, -1, 0}).error, 4, 1e-5);
  EXPECT_NEAR(field.at({-90, 0, 0}, {0, 1, 0}).distance, 10, 1e-4);
  EXPECT_EQ(field.at({0, 0, 0}, {1, 0, 0}).error, 0);
}

TEST(ErrorField, WhatMayBeNoiseIsNoError) {
  EXPECT_EQ(field_of({floor_point(0, 1.1, 0.2), floor_point(1, 1.1, 0.2)}).at({0, 0, 0}, {0, 1, 0}).error, 0);
  EXPECT_NEAR(field_of({floor_point(0, 1.1, 0.01), floor_point(1, 1.1, 0.01)}).at({0, 0, 0}, {0, 1, 0}).error, 0.1, 0.002);
}

TEST(WorstPoints, AreThoseThatNoiseDoesNotExplain) {
  Verification verification;
  verification.points = {floor_point(0, 1.1), floor_point(1, 1.2, 0.5), floor_point(2, 0.8)};
  verification.points.push_back(floor_point(3, 9));
  verification.points.back().standing = Standing::hidden;
  const auto worst = worst_points(verification, 10);
  ASSERT_EQ(worst.size(), 3u);
  EXPECT_EQ(worst[0].at.position.x, 2);
  EXPECT_EQ(worst[1].at.position.x, 0);
}

/// Returns how many of 1500 points lie under or inside a solid.
std::size_t hidden_points(const Scene& scene) {
  const BaseMesh mesh(scene);
  std::vector<LeafValue> leaves;
  for (std::uint32_t r = 0; r < mesh.roots().size(); ++r) leaves.push_back({PatchId::root(r), {1, 1, 1}});
  return verify(scene, build_display_mesh(mesh, leaves), {.points = 1500, .trace = {.paths = 1024, .threads = 2}}).hidden;
}

// Float32 traversal lets a few paths through the seams of a solid. Here, seams of 0.07 mm do.
TEST(Verification, PointsInASolidAreHiddenThoughSomePathsSlipIn) {
  const Scene tight = test::coloured_room();
  Scene leaky = tight;
  const Face& top_of_block = leaky.faces[7];
  for (std::uint32_t c = 0; c < top_of_block.corner_count; ++c)
    leaky.vertices[leaky.corners[top_of_block.first_corner + c]].y += 7e-5;
  EXPECT_GT(hidden_points(tight), 20u);
  EXPECT_EQ(hidden_points(leaky), hidden_points(tight));
}

const std::string cornell_box = ALVOR_SCENES "/cornell_box.obj";

class Verify : public test::CommandLine {
 protected:
  void SetUp() override { ASSERT_EQ(run("solve " + cornell_box + " -o room.glb --threads 2").status, 0); }
  Ran verify(const std::string& options) const { return run("verify " + cornell_box + " room.glb " + options); }
};

/// Returns the nRMSE against the stored truth of 300 points, computed without verify's code.
double stored_error(const std::string& probed) {
  std::istringstream got(probed);
  std::ifstream truth(ALVOR_TEST_FILES "/truth/cornell_box.irradiance.csv");
  const auto band_mean = [](std::istream& lines) {
    std::string line;
    std::getline(lines, line);
    double number = 0, sum = 0;
    std::istringstream cells(line);
    for (int n = 0; n < 9 && cells >> number; ++n, cells.ignore()) sum += n >= 6 ? number / 3 : 0;
    return sum;
  };
  band_mean(got), band_mean(truth);  // headers
  double squares = 0, sum = 0;
  for (int n = 0; n < 300; ++n) {
    const double exact = band_mean(truth);
    squares += std::pow(band_mean(got) - exact, 2), sum += exact;
  }
  return std::sqrt(squares * 300) / sum;
}

TEST_F(Verify, AgreesWithTheStoredTruth) {
  const Ran probed = run("probe room.glb --points " ALVOR_TEST_FILES "/truth/cornell_box.points.csv");
  const double stored = stored_error(probed.out);
  const Ran ran = verify("--json --points 1500 --paths 500");
  ASSERT_EQ(ran.status, 0) << ran.err;
  const auto json = nlohmann::json::parse(ran.out);
  const auto nrmse = json.at("nrmse");
  // The 300 points lie in other places; their own confidence interval is about 20 % either way.
  EXPECT_LE(nrmse.at("low").get<double>(), 1.2 * stored);
  EXPECT_GE(nrmse.at("high").get<double>(), 0.8 * stored);
  EXPECT_GT(json.at("hidden"), 0);  // the floor under the blocks
  EXPECT_EQ(json.at("points").get<int>() + json.at("hidden").get<int>() + json.at("dark").get<int>(), 1500);
  EXPECT_EQ(json.at("worst").size(), 10u);
  const auto& told = json.at("told");
  EXPECT_GT(told.at("nrmse").get<double>(), 0.5 * nrmse.at("value").get<double>());
  EXPECT_GT(told.at("within_one").get<double>(), 0.5);
  EXPECT_GT(told.at("within_two").get<double>(), 0.88);
}

TEST_F(Verify, EndsWithFiveIfTheErrorExceedsWhatIsAllowed) {
  ASSERT_EQ(run("solve " + cornell_box + " -o room.glb --tolerance 0.3 --max-depth 2").status, 0);
  EXPECT_EQ(verify("--points 200 --paths 500 --max-error 0.5").status, 0);
  const Ran ran = verify("--points 200 --paths 500 --max-error 0.001");
  EXPECT_EQ(ran.status, 5);
  EXPECT_NE(ran.out.find("nRMSE"), std::string::npos);
  EXPECT_NE(ran.err.find("--max-error"), std::string::npos);
  EXPECT_EQ(std::ranges::count(ran.err, '\n'), 1) << ran.err;
}

TEST_F(Verify, WritesTheSamePointsWhateverTheThreads) {
  ASSERT_EQ(verify("--points 60 --paths 64 --csv one.csv --threads 1").status, 0);
  ASSERT_EQ(verify("--points 60 --paths 64 --csv two.csv --threads 2").status, 0);
  const std::string csv = text_of(file("one.csv"));
  EXPECT_EQ(csv, text_of(file("two.csv")));
  EXPECT_EQ(std::ranges::count(csv, '\n'), 61);
  EXPECT_TRUE(csv.starts_with("x,y,z,nx,ny,nz,truth_r,truth_g,truth_b,standard_error_r,")) << csv;
}

TEST_F(Verify, DrawsTheError) {
  ASSERT_EQ(verify("--points 60 --paths 64 --picture error.png").status, 0);
  EXPECT_GT(fs::file_size(file("error.png")), 10'000u);
}

TEST_F(Verify, BadFilesAreNamedInOneLine) {
  write("triangle.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  write("room.ply", "not a solution\n");
  for (const std::string files :
       {"missing.obj room.glb", "triangle.obj room.glb", "triangle.obj room.ply", "triangle.obj none.glb"}) {
    const Ran ran = run("verify " + files);
    EXPECT_EQ(ran.status, 3) << files;
    EXPECT_NE(ran.err.find("alvor: "), std::string::npos) << ran.err;
    EXPECT_TRUE(ran.out.empty()) << ran.out;
  }
}

TEST_F(Verify, ImpossibleOptionsAreUsageErrors) {
  for (const std::string option :
       {"--points 0", "--points 1000000000000", "--paths 1", "--paths -5", "--time-limit 0", "--max-error nan", "--threads 0",
        "--picture error.jpg", "--csv nowhere/v.csv", "--absorption -1,0,0", "--absorption 1"})
    EXPECT_EQ(verify(option).status, 2) << option;
}

TEST_F(Verify, AMediumIsVerifiedWhereItWasSolved) {
  ASSERT_EQ(run("solve " + cornell_box + " -o room.glb --absorption 0.001,0.001,0.001").status, 0);
  EXPECT_EQ(verify("--points 300 --paths 500 --absorption 0.001,0.001,0.001 --max-error 0.05").status, 0);
  EXPECT_EQ(verify("--points 300 --paths 500 --max-error 0.05").status, 5);
}

}  // namespace
}  // namespace alvor
