#pragma once
// All strategies on one mesh and one set of rows, each from the start to the solution of the same system.

#include "meshing/base_mesh.h"
#include "radiosity/exchange/strategies.h"
#include "solution/leaf_value.h"

#include <cstdint>
#include <optional>
#include <stop_token>
#include <vector>

namespace alvor {

struct CompareOptions {
  double tolerance = 0.02;    ///< the mesh and rows are those of a solve that stops at this estimated error
  std::uint64_t steps = 100;  ///< after how many the strategies are looked at
  std::uint64_t seed = 1;
  int threads = 0;  ///< for rays; 0: as many as the machine has. Strategies run on one
};

/// How far a strategy had come. The error is the area-weighted RMS error of the displayed radiosity over the RMS radiosity, both
/// against the solution of the same system; emitters that light by shadow rays count with what they reflect.
struct ErrorSample {
  std::uint64_t steps = 0;  ///< patches shot or gathered
  double cpu_s = 0;         ///< of the one thread
  double error = 0;
};

struct StrategyCourse {
  Strategy strategy = Strategy::automatic;
  std::vector<ErrorSample> curve;  ///< every step at first, then every 2 %
  /// After CompareOptions::steps, or fewer if nothing was left to do.
  double error = 0;
  std::vector<LeafValue> leaves;
  Rgb ambient_irradiance;  ///< to be added to what is displayed, W/m2; zero for strategies that do not
};

/// Leaves are in the order of their ids.
struct Comparison {
  std::size_t patches = 0, leaves = 0;  ///< patches shoot and gather, leaves are displayed
  std::vector<LeafValue> converged;
  std::vector<StrategyCourse> courses;  ///< gather, shoot, sorted, sorted+ambient, overshoot; none in the dark
};

/// The start is the same for all: nothing is shot, and direct light, which does not come by rows, is unshot on its receivers.
/// That is the state after the emitters have shot. Each goes on until its error is 1e-6, or far beyond reason. A stop request
/// ends it early, with what there is. Requires: !mesh.roots().empty().
Comparison compare_strategies(const BaseMesh& mesh, const CompareOptions& options, std::stop_token stop);

/// From how many steps on the error stays at or below `error`; nothing if it never does.
std::optional<std::uint64_t> steps_to(double error, const StrategyCourse& course);

}  // namespace alvor
