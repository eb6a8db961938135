#pragma once
// Light that arrives straight from emitters.

#include "radiosity/direct/emitter.h"
#include "radiosity/direct/light_tree.h"
#include "radiosity/rays/local_scene.h"
#include "radiosity/rays/ray_budget.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace alvor {

/// What emitters give a patch: irradiance averaged over the part of the patch that is not hidden.
struct DirectLight {
  Rgb irradiance;
  /// What arrives at each origin as far as its own rays tell; mean over bands. Origins are those of transport rows.
  std::array<float, origins_per_patch> at_origin{};
  float variance = 0;         ///< of the irradiance by shadow rays, mean over bands, (W/m2)^2
  float origin_variance = 0;  ///< of at_origin by shadow rays, mean over origins
};

/// A patch that receives. `hidden_origins` as in TransportRow.
struct Receiver {
  PatchId patch;
  PatchShape shape;
  std::uint16_t hidden_origins = 0;
};

/// What light needs on its way from emitters. Where it is not needed it takes no time.
struct ShadowNeeds {
  bool occlusion = true;  ///< false: nothing stands between any receiver and emitter, so no rays are sent
  bool medium = true;     ///< false: the medium is clear
};

/// Adds the light of every one of `emitters` to `light`, one entry per receiver: the exact form factor (Lambert's contour
/// formula, mean over the four quarters of the patch) times the visible fraction. That fraction is the mean visibility of shadow
/// rays between stratified points of patch and emitter, weighted by the kernel cos cos / r2; sixteen rays, and 48 more where they
/// disagree on an emitter that matters. In parallel; does not depend on the number of threads.
void add_direct_light(const LocalScene& scene, std::span<const Emitter> emitters, std::span<const Receiver> receivers,
                      std::uint64_t seed, RayBudget& budget, std::span<DirectLight> light, ShadowNeeds needs = {});

/// The same for many emitters: those that may matter to a receiver as above, the rest of the tree by sampling emitters in
/// proportion to bounds on what they give (no bias: nothing is skipped). Requires: a tree of these emitters.
void add_direct_light(const LocalScene& scene, std::span<const Emitter> emitters, const LightTree& tree,
                      std::span<const Receiver> receivers, std::uint64_t seed, RayBudget& budget, std::span<DirectLight> light,
                      ShadowNeeds needs = {});

}  // namespace alvor
