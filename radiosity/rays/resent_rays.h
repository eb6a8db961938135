#pragma once
// Sends single rays of a row again after something in the scene has moved.

#include "radiosity/rays/local_scene.h"
#include "radiosity/rays/ray_budget.h"
#include "radiosity/rays/ray_source.h"

#include <optional>
#include <span>
#include <vector>

namespace alvor {

/// A ray of a transport row: from its origin (local units, off the surface as sample_points() puts it) towards where it ended.
struct ResentRay {
  Vec3 from, towards;
};

/// Returns the place where each ray ends now, on the side that it meets; nothing where it leaves the scene or meets a black back.
/// A ray that slips through a seam is sent once more, slightly turned towards `normal`. Requires: no panes in the scene.
std::vector<std::optional<PatchId>> resend(const LocalScene& scene, std::span<const ResentRay> rays, Vec3 normal,
                                           RayBudget& budget);

/// Sends one ray from each of the sixteen sample points of a patch of `root`, each in another direction of the hemisphere.
/// Returns a bit for each point: whether its ray met a back that has no other side, as all rays do that start inside a solid.
std::uint16_t meet_backs(const LocalScene& scene, std::uint32_t root, const PatchPoints& points, RayBudget& budget);

}  // namespace alvor
