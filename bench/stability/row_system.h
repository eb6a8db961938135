#pragma once
// The rows of a scene on its first mesh, solved by sweeps and by a dense matrix.

#include "bench/stability/case.h"
#include "radiosity/exchange/shooting.h"
#include "radiosity/solve/solver.h"

#include <memory>

namespace alvor::bench {

class RowSystem {
 public:
  /// On one thread. Rows on the mesh that a solve of this depth begins with.
  RowSystem(const Scene& scene, int max_depth, Strategy strategy = Strategy::automatic);
  ~RowSystem();

  std::size_t size() const { return dense_.size(); }
  /// Sweeps down to `enough` of Exchange::remaining_error, for most_seconds at most.
  void settle(double enough);
  /// Sweeps until error() is at most this; the number of steps of one row or column a patch, with those before the first sweep:
  /// direct light of the patches that emit, and what is unshot at first.
  double steps_down_to(double error);

  /// RMS difference of radiosity from the dense solution over the latter's mean, by area.
  double error() const;
  /// Of irradiance by rows, on the patch where it is largest.
  double worst_relative_error() const;
  /// With the steps and seconds of sweeps so far, and the remaining error as the exchange knows it.
  Measured measured(std::string obtained, double error) const;

 private:
  void read(const Shooting& system);
  double area() const;
  struct Parts;
  std::unique_ptr<Parts> parts_;
  std::vector<double> dense_, area_, reflectance_;  // by patch: irradiance, m2, -
  double mean_radiosity_ = 0, emitting_share_ = 0;
  std::size_t steps_ = 0;
  double seconds_ = 0;
  std::string end_;
};

}  // namespace alvor::bench
