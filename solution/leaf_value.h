#pragma once
// The records of the published solution: the value of a leaf, and the progress at a step.

#include "solution/patch_id.h"
#include "solution/rgb.h"

#include <cstdint>

namespace alvor {

/// The irradiance H of a leaf, W/m2 per band, averaged over the visible part of the leaf. Radiosity is E + rho H of the leaf's
/// material. Exactly zero means that no light arrives, as under a box that stands on a floor.
struct LeafValue {
  PatchId patch;
  RgbF irradiance;
  friend bool operator==(const LeafValue&, const LeafValue&) = default;
};

/// Progress of the solve at one published revision; one line of the report.
struct Step {
  std::uint64_t revision = 0;  ///< the revision this step made; 1 is the first
  double elapsed_s = 0;        ///< since the solve began, s
  std::uint64_t step = 0;      ///< counts published steps from 0
  std::uint64_t shots = 0;     ///< shots so far
  std::uint64_t rays = 0;      ///< rays so far, shadow rays included
  std::uint64_t leaves = 0;    ///< leaves now
  /// Sum |unshot power| / emitted power. 1 while it is not known: right after an edit.
  double unshot_fraction = 1;
  double estimated_error = 1;  ///< estimate of nRMSE of the irradiance against truth
  /// The displayed irradiance of a leaf may differ from the solution by this fraction of the leaf's irradiance, or of an eighth
  /// of the mean irradiance where that is larger.
  double displayed_error = 0;
  double unlit_fraction = 0;    ///< fraction of the area that light may reach whose irradiance is still unknown, published as 0
  double area_within = 0;       ///< share of the visible area whose told error is within the tolerance, see ErrorByPlace
  std::uint64_t edits = 0;      ///< revision of the newest edits of the scene that this state heeds; 0: of none
  bool is_provisional = false;  ///< shows an edit at once, before the light that it changes has gone round; replaced soon
  Rgb ambient_irradiance;       ///< display only: add to every leaf's irradiance (Cohen et al. 1988), W/m2
  friend bool operator==(const Step&, const Step&) = default;
};

}  // namespace alvor
