#pragma once
// A scene and what solving it published.

#include "bench/stability/case.h"
#include "radiosity/solve/solver.h"

#include <functional>
#include <optional>

namespace alvor::bench {

inline constexpr double most_seconds = 10;  // that a solve may take

class SolvedScene {
 public:
  /// On one thread, for most_seconds at most.
  explicit SolvedScene(const Scene& scene, SolveOptions options = {});

  const std::optional<Fault>& fault() const { return fault_; }
  const BaseMesh& mesh() const { return *mesh_; }
  const std::vector<LeafValue>& leaves() const { return leaves_; }
  const Material& material_of(const LeafValue& leaf) const { return mesh_->material_of(leaf.patch.root_face()); }
  double area_of(const LeafValue& leaf) const;

  /// Largest relative difference of a leaf's irradiance, in any band, from what is expected of all.
  double worst_error(const Rgb& expected) const;
  /// The same, of leaves that are not exactly dark.
  double worst_error_where_lit(const Rgb& expected) const;
  /// Of the area, on leaves that are not exactly dark.
  double lit_share() const;
  /// Irradiance over the area of the roots that are chosen.
  Rgb mean_irradiance(const std::function<bool(std::uint32_t root)>& is_chosen) const;
  Rgb mean_irradiance() const;
  Rgb mean_radiosity() const;

  /// With the steps, seconds and estimate of this solve. A scene that was refused or a value that is no number counts as wrong.
  Measured measured(std::string obtained, double error) const;

 private:
  std::optional<Fault> fault_;
  std::optional<BaseMesh> mesh_;
  std::vector<LeafValue> leaves_;
  Step last_;
  SolveOutcome outcome_;
  double seconds_ = 0;
};

/// |value - expected| / expected in the worst band.
double relative_error(const Rgb& value, const Rgb& expected);

}  // namespace alvor::bench
