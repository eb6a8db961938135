#pragma once
// Compares all strategies on one mesh and one set of rows, each from the start to the solution of one system.

#include "meshing/base_mesh.h"
#include "radiosity/exchange/strategies.h"
#include "solution/leaf_value.h"

#include <cstdint>
#include <optional>
#include <stop_token>
#include <vector>

namespace alvor {

struct CompareOptions {
  double tolerance = 0.02;    ///< estimated error at which the solve stops that makes the mesh and the rows
  std::uint64_t steps = 100;  ///< steps after which each strategy's picture is kept
  std::uint64_t seed = 1;
  int threads = 0;  ///< threads for rays; 0: as many as the machine has. Strategies run on one thread
};

/// The error of a strategy after some steps: the RMS error over the area of the displayed radiosity, divided by the RMS radiosity
/// of the solution of the system. Emission that rows do not carry is left out of both.
struct ErrorSample {
  std::uint64_t steps = 0;  ///< patches shot or gathered
  double cpu_s = 0;         ///< CPU seconds of the strategy's thread
  double error = 0;
};

/// The way of one strategy from the start to the solution.
struct StrategyCourse {
  Strategy strategy = Strategy::automatic;
  std::vector<ErrorSample> curve;  ///< after every step at first, then each time the steps have grown by 2 %
  double error = 0;                ///< error after CompareOptions::steps, or after fewer steps if nothing was left to do
  std::vector<LeafValue> leaves;   ///< irradiance, W/m2, after as many steps as `error`
  Rgb ambient_irradiance;          ///< to be added to `leaves` for display, W/m2; zero for strategies that show no ambient term
};

/// The result of compare_strategies(). Leaves are in the order of their ids.
struct Comparison {
  std::size_t patches = 0, leaves = 0;  ///< patches shoot and gather, leaves are displayed
  std::vector<LeafValue> converged;     ///< irradiance of the solution, W/m2
  std::vector<StrategyCourse> courses;  ///< gather, shoot, sorted, sorted+ambient, overshoot; none in the dark
};

/// Runs all strategies on one system and returns their courses. All start with nothing shot and with direct light, which does not
/// come by rows, unshot on its receivers: the state after the emitters have shot. Each goes on until its error is 1e-6, or for at
/// most 1000 steps per patch. A stop request ends the comparison early, with the results so far. Requires: !mesh.roots().empty().
Comparison compare_strategies(const BaseMesh& mesh, const CompareOptions& options, std::stop_token stop);

/// Returns the number of steps from which on the error stays at or below `error`; nothing if it does not at the end.
std::optional<std::uint64_t> steps_to(double error, const StrategyCourse& course);

}  // namespace alvor
