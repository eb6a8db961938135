#pragma once
// Luminaires that shine from a flat opening, a box or a cylinder.

#include "meshing/light.h"
#include "meshing/opening_face.h"
#include "radiosity/direct/light_source.h"
#include "radiosity/rays/local_scene.h"

#include <vector>

namespace alvor {

/// A luminaire with a luminous opening. Each piece of the opening sends light as the photometric web says, in proportion to the
/// area that it shows in that direction, so that the opening as a whole has the web's intensities from afar. A flat opening
/// shines to both sides. Unblocked irradiance is the integral over the opening by Gauss' rule, on pieces that are small beside
/// their distance; shadow rays go to points that are uniform by area.
class OpeningLight final : public LightSource {
 public:
  /// `colour`, `power` and `greatest` are as for LampLight. Requires: `luminaire` shines from faces (see faces_of_opening());
  /// !fault_in(luminaire).
  OpeningLight(const LocalScene& scene, std::uint32_t number, const Light& luminaire, const RelativeLight& colour, double power,
               double greatest);

  double unblocked(Vec3 at, Vec3 normal) const override;
  void aim(const ShadowAim& aim, std::size_t first, std::size_t last) const override;
  double sample_scale(double probability) const override { return 1 / probability; }
  std::optional<LightExtent> extent() const override;

 private:
  double brings(const OpeningFace& face, Vec3 from, Vec3 at, Vec3 normal) const;
  double shown_area(Vec3 direction) const;
  const OpeningFace& choose(Uv& at) const;

  const HungWeb web_;
  std::vector<OpeningFace> faces_;  // local units, as all lengths below
  const double greatest_;
  double area_ = 0;
  Vec3 place_, low_, high_;
};

}  // namespace alvor
