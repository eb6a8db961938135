#pragma once
// Light that arrives straight from emitters.

#include "radiosity/local_scene.h"
#include "radiosity/ray_budget.h"

#include <cstdint>
#include <span>
#include <vector>

namespace alvor {

/// A root patch whose light is carried by exact form factors and shadow rays.
struct Emitter {
  std::uint32_t root = 0;
  Rgb emission;      ///< E, W/m2
  double power = 0;  ///< sum over bands of E times area, W
};

/// What one emitter, or all, give a patch: irradiance averaged over the part of the patch that is not hidden.
struct DirectLight {
  Rgb irradiance;
  bool partly_shadowed = false;
};

/// A patch that receives. `hidden_origins` as in TransportRow.
struct Receiver {
  PatchId patch;
  PatchShape shape;
  std::uint16_t hidden_origins = 0;
};

/// Adds the light of `emitter` to `light`, one entry per receiver: the exact form factor (Lambert's contour formula, mean over
/// the four quarters of the patch) times the visible fraction. That fraction is the mean visibility of shadow rays between
/// stratified points of patch and emitter, weighted by the kernel cos cos / r2; sixteen rays, and 48 more where they disagree.
void add_direct_light(const LocalScene& scene, const Emitter& emitter, std::span<const Receiver> receivers, std::uint64_t seed,
                      RayBudget& budget, std::span<DirectLight> light);

}  // namespace alvor
