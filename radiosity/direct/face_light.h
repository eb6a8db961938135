#pragma once
// The light of an emitting face.

#include "radiosity/direct/light_source.h"
#include "radiosity/rays/local_scene.h"

namespace alvor {

/// Returns whether a point lies before a face whose front is where `normal` (unit) points, and not in its plane but for rounding:
/// seen from the back of a lamp with two sides, the form factor of its front would be 0 or 1, as rounding falls. `face` has three
/// corners or four, in local units.
bool is_before(Vec3 at, std::span<const Vec3> face, Vec3 normal);

/// A root patch that emits diffusely from its front. Unblocked irradiance is Lambert's contour formula; shadow rays go to points
/// that are uniform in the root's coordinates, with the weight cos cos / r2.
class FaceLight final : public LightSource {
 public:
  /// `emission` is E of what is there of the root patch, `cover` the share that is.
  FaceLight(const LocalScene& scene, std::uint32_t root, const RelativeLight& emission, double cover = 1);

  std::uint32_t root() const { return number(); }
  bool may_reach(std::uint32_t receiver) const override { return receiver != root(); }
  double unblocked(Vec3 at, Vec3 normal) const override;
  void aim(const ShadowAim& aim, std::size_t first, std::size_t last) const override;
  double sample_scale(double probability) const override;
  std::optional<LightExtent> extent() const override;
  std::span<const Vec3> polygon() const override;

 private:
  const LocalScene& scene_;
};

}  // namespace alvor
