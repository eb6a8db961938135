#pragma once
// The light of a lamp that is made of many emitting faces, such as a globe or a tube.

#include "radiosity/direct/light_source.h"
#include "radiosity/rays/local_scene.h"

#include <cstdint>
#include <span>
#include <vector>

namespace alvor {

/// Root patches of one material that emit diffusely from their fronts, as one light. Unblocked irradiance is the sum over the
/// faces, each by Lambert's contour formula, or as if from its middle if it is small as seen from there. Four of five shadow rays
/// go to faces chosen by what they bring to the middle of the receiver, the others to faces chosen by area; on a face, to points
/// that are uniform in its coordinates.
class MeshLight final : public LightSource {
 public:
  /// `emission` is E of what is there of the root patches, `power` that of all of them. Requires: at least one root.
  MeshLight(const LocalScene& scene, std::vector<std::uint32_t> roots, const RelativeLight& emission, double power);

  double unblocked(Vec3 at, Vec3 normal) const override;
  void aim(const ShadowAim& aim, std::size_t first, std::size_t last) const override;
  double sample_scale(double probability) const override;
  std::optional<LightExtent> extent() const override;

 private:
  /// A root patch in local units.
  struct LitFace {
    std::uint32_t root;
    Vec3 middle, normal;
    double area;
    double far_squared;  ///< the squared distance from which on the face counts as if all of it were in its middle
  };
  double brings(const LitFace& face, Vec3 at, Vec3 normal) const;
  /// Returns for each face the probability that it or a face before it is chosen for a shadow ray from a place.
  std::vector<double> shares_up_to(Vec3 at, Vec3 normal) const;

  const LocalScene& scene_;
  std::vector<LitFace> faces_;
  double area_ = 0;  // local units
};

/// Returns the emitting roots in groups: all faces of a lamp that is to be one light, or a single face.
std::vector<std::vector<std::uint32_t>> lamps_of_faces(const LocalScene& scene);

}  // namespace alvor
