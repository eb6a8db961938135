#pragma once
// What is published about a leaf, and about a step of the solve.

#include "solution/patch_id.h"
#include "solution/rgb.h"

#include <cstdint>

namespace alvor {

/// Irradiance H of a leaf, W/m2 per band, averaged over the part of it that can be seen. Radiosity is E + rho H of its
/// material. Exactly zero means that nothing arrives there, as under a box standing on a floor.
struct LeafValue {
  PatchId patch;
  RgbF irradiance;
  friend bool operator==(const LeafValue&, const LeafValue&) = default;
};

/// Progress at one published revision. One line of the report.
struct Step {
  std::uint64_t revision = 0;  ///< the revision this step made; 1 is the first
  double elapsed_s = 0;        ///< since the solve began
  std::uint64_t step = 0;      ///< counts published steps from 0
  std::uint64_t shots = 0;     ///< shots so far
  std::uint64_t rays = 0;      ///< rays so far, shadow rays included
  std::uint64_t leaves = 0;    ///< leaves now
  double unshot_fraction = 1;  ///< sum |unshot power| / emitted power
  double estimated_error = 1;  ///< estimate of nRMSE of the irradiance against truth
  /// What is displayed may differ from the solution by this share of itself, or of an eighth of the mean where that is more.
  double displayed_error = 0;
  double unlit_fraction = 0;  ///< share of the area that light may reach whose irradiance is not known yet: published as 0
  Rgb ambient_irradiance;     ///< display only: add to every leaf's irradiance (Cohen et al. 1988), W/m2
  friend bool operator==(const Step&, const Step&) = default;
};

}  // namespace alvor
