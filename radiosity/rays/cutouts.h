#pragma once
// The opacity of a face where a ray hits it.

#include "meshing/base_mesh.h"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace alvor {

/// Returns the share of light that goes straight on where so much of a surface is there and lets `transmittance` through.
inline RgbF straight_through(const RgbF& transmittance, float opacity) {
  const float hole = 1 - opacity;
  return opacity * transmittance + RgbF{hole, hole, hole};
}

/// The holes in the faces of a mesh, by root. Takes no memory if no material has any. Immutable; safe from any thread.
/// Borrows the mesh.
class Cutouts {
 public:
  explicit Cutouts(const BaseMesh& mesh);

  /// Returns the share of the surface that is there, in [0, 1], where a ray hits a root at Embree's coordinates.
  float opacity(std::uint32_t root, float u, float v) const {
    return roots_.empty() || !roots_[root] ? 1 : opacity(*roots_[root], u, v);
  }

 private:
  /// How an image lies on a root: linear on (corner 0, 1, 2), and of a quad on (0, 2, 3).
  struct Placed {
    const Texture* texture;
    std::array<TexturePoint, 4> points;
    bool is_quad;
    float fourth_a, fourth_b;  ///< corner 3 is corner 0 + a (corner 1 - corner 0) + b (corner 2 - corner 0)
  };
  static float opacity(const Placed& placed, float u, float v);

  std::vector<std::optional<Placed>> roots_;
};

}  // namespace alvor
