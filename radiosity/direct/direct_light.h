#pragma once
// Light that arrives straight from lights.

#include "radiosity/direct/blocker_tree.h"
#include "radiosity/direct/light_source.h"
#include "radiosity/direct/light_tree.h"
#include "radiosity/rays/local_scene.h"
#include "radiosity/rays/ray_budget.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace alvor {

/// The irradiance that a patch receives straight from lights, averaged over the part of the patch that is not hidden.
struct DirectLight {
  RelativeLight irradiance;
  /// Irradiance at each origin of the patch, from the origin's own shadow rays; mean over bands, in emission units. The origins
  /// are those of transport rows.
  std::array<float, origins_per_patch> at_origin{};
  float variance = 0;         ///< noise of `irradiance` from shadow rays: variance, mean over bands, emission units squared
  float origin_variance = 0;  ///< noise of `at_origin` from shadow rays: variance, mean over origins, emission units squared

  /// Adds what other lights bring.
  DirectLight& operator+=(const DirectLight& other) {
    irradiance += other.irradiance;
    for (std::size_t o = 0; o < at_origin.size(); ++o) at_origin[o] += other.at_origin[o];
    variance += other.variance;
    origin_variance += other.origin_variance;
    return *this;
  }
};

/// Largest Receiver::ray_level: 64 times the rays of level 0. The noise of a light that is half hidden is then told as 0.2 % of
/// what it would bring unhidden.
inline constexpr int most_ray_level = 3;
/// Returns how many times the shadow rays of level 0 a receiver of this level sends.
constexpr std::uint32_t times_at(int ray_level) { return 1u << 2 * ray_level; }

/// A patch that receives direct light. `hidden_origins` has the bits of TransportRow::hidden_origins. At each level of rays a
/// patch sends four times the shadow rays of the level below.
struct Receiver {
  PatchId patch;
  PatchShape shape;
  std::uint16_t hidden_origins = 0;
  std::uint8_t ray_level = 0;  ///< in [0, most_ray_level]
};

/// Which effects on the way from light to receiver are computed. An effect that is off takes no time.
struct ShadowNeeds {
  bool occlusion = true;                  ///< false: nothing stands between any receiver and light, so no rays are sent
  bool medium = true;                     ///< false: the medium is clear
  bool partial = true;                    ///< false: no face lets light straight through, and all of a light is there
  const BlockerTree* blockers = nullptr;  ///< the scene's; null: shadows are found by rays alone
  bool exact_faces = true;                ///< false: of flat lights shadows are found by rays, blockers or not
};

/// Adds to `light` what every one of `lights` brings: its unblocked irradiance (mean over the four quarters of the patch) times
/// its visible fraction. That fraction is the mean visibility of shadow rays between stratified points of patch and light,
/// weighted by what each ray would bring (LightSource::aim). At level 0 sixteen rays are sent, and 48 more where they disagree on
/// a light that brings a tenth of the irradiance; at each level more four times these numbers, and a light is looked at more
/// closely that brings half of that share. In parallel; the result does not depend on the number of threads. Returns early where
/// the budget is out. Requires: one entry of `light` per receiver.
void add_direct_light(const LocalScene& scene, LightSources lights, std::span<const Receiver> receivers, std::uint64_t seed,
                      RayBudget& budget, std::span<DirectLight> light, ShadowNeeds needs = {});

/// Adds to `light` what many lights bring. Those that LightTree::choose calls single are treated one by one, as above; 32 rays,
/// at each level four times as many, go to lights drawn from the rest in proportion to bounds on what they bring. No light is
/// skipped, so there is no bias. Requires: one entry of `light` per receiver.
void add_direct_light(const LocalScene& scene, const LightTree& tree, std::span<const Receiver> receivers, std::uint64_t seed,
                      RayBudget& budget, std::span<DirectLight> light, ShadowNeeds needs = {});

}  // namespace alvor
