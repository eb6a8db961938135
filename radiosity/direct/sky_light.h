#pragma once
// Light of skies and environments: of a sky from all its directions for faces in the open; of both through exits for the others
// (see SkyExits).

#include "radiosity/direct/distant_radiance.h"
#include "radiosity/direct/light_source.h"
#include "radiosity/direct/normal_table.h"
#include "radiosity/direct/scene_box.h"
#include "radiosity/direct/sky_exits.h"
#include "radiosity/rays/local_scene.h"

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace alvor {

/// The whole dome of a sky, for open faces. Unblocked irradiance is interpolated in a table over normals; the directions of
/// shadow rays are cosine-distributed about the receiver's normal.
class DomeLight final : public LightSource {
 public:
  /// `colour` is the irradiance of an open surface that faces the zenith; `power` is that of LightSource.
  DomeLight(const LocalScene& scene, std::uint32_t number, const SkyDome& dome, const RelativeLight& colour, double power,
            std::shared_ptr<const SkyExits> exits);

  bool may_reach(std::uint32_t root) const override { return exits_->is_open[root]; }
  double unblocked(Vec3 at, Vec3 normal) const override;
  void aim(const ShadowAim& aim, std::size_t first, std::size_t last) const override;
  double sample_scale(double probability) const override { return 1 / probability; }
  std::optional<LightExtent> extent() const override { return std::nullopt; }

 private:
  const SkyDome dome_;
  const std::shared_ptr<const SkyExits> exits_;
  const SceneBox box_;
  const NormalTable irradiance_;
};

/// The light that a sky or an environment sends through one exit, for closed faces. Unblocked irradiance is the integral over the
/// exit by Gauss' rule; shadow rays go through points that are uniform by area, to the scene's bounding box. A ray that counts at
/// another exit (see SkyExits::counts_at) brings nothing.
class ExitLight final : public LightSource {
 public:
  /// `power` is that of LightSource.
  ExitLight(const LocalScene& scene, std::uint32_t number, std::shared_ptr<const DistantRadiance> radiance,
            const RelativeLight& colour, double power, std::shared_ptr<const SkyExits> exits, std::size_t which);

  bool may_reach(std::uint32_t root) const override { return !exits_->is_open[root]; }
  double unblocked(Vec3 at, Vec3 normal) const override;
  void aim(const ShadowAim& aim, std::size_t first, std::size_t last) const override;
  double sample_scale(double probability) const override { return 1 / probability; }
  std::optional<LightExtent> extent() const override { return std::nullopt; }
  bool has_partial_rays() const override { return which_ > 0; }
  std::span<const Vec3> aperture() const override { return corners_; }
  double through(std::vector<ConvexPolygon>& parts, Vec3 at, Vec3 normal) const override;

 private:
  FlatRectangle above_horizon(Vec3 at) const;
  double brings(Vec3 from, Vec3 at, Vec3 normal) const;
  double mean_radiance(std::span<const Vec3> part, Vec3 at, Vec3 normal) const;

  const std::shared_ptr<const DistantRadiance> radiance_;
  const std::shared_ptr<const SkyExits> exits_;
  const std::size_t which_;
  const FlatRectangle& exit_;
  const std::array<Vec3, 4> corners_;
  const SceneBox box_;
  const std::optional<Vec3> zenith_;
};

}  // namespace alvor
