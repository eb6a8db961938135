#pragma once
// The rows of a scene on its first mesh, solved by sweeps and, for comparison, as a dense matrix.

#include "bench/stability/case.h"
#include "radiosity/exchange/shooting.h"
#include "radiosity/solve/solver.h"

#include <memory>

namespace alvor::bench {

class RowSystem {
 public:
  /// Traces rows on the mesh with which a solve of this depth begins, on one thread.
  RowSystem(const Scene& scene, int max_depth, Strategy strategy = Strategy::automatic);
  ~RowSystem();

  std::size_t size() const { return dense_.size(); }
  /// Sweeps until Exchange::remaining_error is at most `enough`, for at most most_seconds.
  void settle(double enough);
  /// Sweeps until error() is at most `error`. Returns the number of steps (of one row or column each) per patch, with those
  /// before the first sweep: direct light of the emitting patches, and what is unshot at first.
  double steps_down_to(double error);

  /// Returns the RMS difference of radiosity from the dense solution, weighted by area, over the dense solution's mean.
  double error() const;
  /// Returns the relative error of irradiance on the patch where it is largest.
  double worst_relative_error() const;
  /// Returns the result with the steps and seconds of the sweeps so far, and the remaining error as the exchange estimates it.
  Measured measured(std::string obtained, double error) const;

 private:
  void read(const Shooting& system);
  double area() const;
  struct Parts;
  std::unique_ptr<Parts> parts_;
  std::vector<double> dense_, area_, reflectance_;  // by patch: irradiance W/m2, area m2, reflectance
  double mean_radiosity_ = 0, emitting_share_ = 0;
  std::size_t steps_ = 0;
  double seconds_ = 0;
  std::string end_;
};

}  // namespace alvor::bench
