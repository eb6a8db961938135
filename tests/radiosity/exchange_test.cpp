#include "radiosity/exchange/exchange.h"

#include "radiosity/exchange/parallel_sum.h"
#include "radiosity/exchange/strategies.h"
#include "tests/radiosity/systems.h"

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <cmath>

namespace alvor {
namespace {

using test::System;

constexpr double rounding = 1e-14;
constexpr Strategy all[]{Strategy::gather, Strategy::shoot, Strategy::sorted, Strategy::overshoot};

bool always(std::size_t) { return true; }

/// Returns the RMS error of the radiosity in the first band, over the mean radiosity.
double true_error(const System& system, std::span<const RelativeLight> solution, const Exchange& exchange) {
  const auto irradiance = exchange.irradiance(), expected = system.gathered(solution);
  double squares = 0, power = 0, area = 0;
  for (std::size_t p = 0; p < irradiance.size(); ++p) {
    const ShootingPatch& patch = system.patches[p];
    squares += patch.area * std::pow(patch.reflectance.r * (irradiance[p].r - expected[p].r), 2);
    power += patch.area * solution[patch.first_leaf].r;
    area += patch.area;
  }
  return std::sqrt(squares / area) / (power / area);
}

TEST(ParallelSum, IsTheSameOnAnyNumberOfThreads) {
  constexpr std::size_t count = 100'000;
  const auto sum = [](int threads) {
    tbb::task_arena arena(threads);
    return arena.execute([] { return parallel_sum<double>(count, [](std::size_t n) { return 1 / (1.0 + double(n)); }); });
  };
  double expected = 0;
  for (std::size_t n = count; n > 0; --n) expected += 1 / double(n);
  EXPECT_NEAR(sum(1), expected, 1e-13 * expected);
  EXPECT_EQ(sum(2), sum(1));
}

TEST(Exchange, RemainingErrorIsNeverLessThanTheErrorOfReciprocalRows) {
  for (const double reflectance : {0.5, 0.95, 0.99}) {
    const System system = System::reciprocal(2, 60, reflectance, 3);
    const auto solution = system.solved();
    for (const Strategy strategy : all) {
      ShotExchange exchange(system.begun(), strategy);
      for (int n = 0; n < 30; ++n, exchange.sweep())
        EXPECT_LE(true_error(system, solution, exchange), exchange.remaining_error() + rounding)
            << text(strategy) << ", rho " << reflectance << ", after " << n << " sweeps";
    }
  }
}

TEST(Exchange, ResidualOfAStiffSystemIsFarFromItsError) {
  // One patch in sixty emits and 99 % is reflected, so one sweep brings only a hundredth of the light.
  const System system = System::reciprocal(3, 60, 0.99, 1);
  ShotExchange exchange(system.begun(), Strategy::shoot);
  EXPECT_EQ(settle(exchange, 1e-3, always), Settling::settled);
  EXPECT_LE(true_error(system, system.solved(), exchange), 1e-3);
}

TEST(Exchange, StrategyThatCannotArriveStallsAndSaysHowFarItIs) {
  const System system = System::reciprocal(4, 20, 1 - 1e-9, 1);
  for (const Strategy strategy : {Strategy::gather, Strategy::shoot}) {
    ShotExchange exchange(system.begun(), strategy);
    EXPECT_EQ(settle(exchange, 0.01, always), Settling::stalled) << text(strategy);
    EXPECT_GT(exchange.remaining_error(), 0.99) << text(strategy);
  }
}

TEST(Exchange, StopsWhenAsked) {
  const System system = System::reciprocal(5, 60, 0.99, 1);
  ShotExchange exchange(system.begun(), Strategy::shoot);
  int sweeps = 0;
  EXPECT_EQ(settle(exchange, 1e-9, [&](std::size_t) { return ++sweeps < 3; }), Settling::stopped);
  EXPECT_EQ(sweeps, 3);
}

TEST(Exchange, NothingRemainsWhereNothingIsReflected) {
  const System system = System::reciprocal(6, 20, 0, 20);
  ShotExchange exchange(system.begun(), Strategy::sorted);
  EXPECT_EQ(settle(exchange, 1e-9, always), Settling::settled);
}

}  // namespace
}  // namespace alvor
