#pragma once
// Solves a scene and evaluates the published solution.

#include "bench/stability/case.h"
#include "radiosity/solve/solver.h"

#include <functional>
#include <optional>

namespace alvor::bench {

inline constexpr double most_seconds = 10;  // limit for a solve

class SolvedScene {
 public:
  /// Solves the scene on one thread, for at most most_seconds.
  explicit SolvedScene(const Scene& scene, SolveOptions options = {});

  const std::optional<Fault>& fault() const { return fault_; }
  const BaseMesh& mesh() const { return *mesh_; }
  const std::vector<LeafValue>& leaves() const { return leaves_; }
  const Material& material_of(const LeafValue& leaf) const { return mesh_->material_of(leaf.patch.root_face()); }
  double area_of(const LeafValue& leaf) const;

  /// Returns the largest relative difference of any leaf's irradiance, in any band, from `expected`.
  double worst_error(const Rgb& expected) const;
  /// Returns the largest relative difference from `expected` over the leaves that are not exactly dark.
  double worst_error_where_lit(const Rgb& expected) const;
  /// Returns the fraction of the area on leaves that are not exactly dark.
  double lit_share() const;
  /// Returns the mean irradiance over the area of the roots that `is_chosen` accepts.
  Rgb mean_irradiance(const std::function<bool(std::uint32_t root)>& is_chosen) const;
  Rgb mean_irradiance() const;
  Rgb mean_radiosity() const;

  /// Returns the result with the steps, seconds and estimate of this solve. If the scene was refused, or a value is negative or
  /// not finite, the error is infinite.
  Measured measured(std::string obtained, double error) const;

 private:
  std::optional<Fault> fault_;
  std::optional<BaseMesh> mesh_;
  std::vector<LeafValue> leaves_;
  Step last_;
  SolveOutcome outcome_;
  double seconds_ = 0;
};

/// Returns |value - expected| / expected in the worst band.
double relative_error(const Rgb& value, const Rgb& expected);

}  // namespace alvor::bench
