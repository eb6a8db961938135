#pragma once

#include "meshing/display_mesh.h"

#include <cstdint>
#include <vector>

namespace alvor {

/// The share of light that goes straight on through a display mesh, by place. Without panes it takes no memory. Immutable; safe
/// from any thread. Borrows the mesh.
class MeshTransmittance {
 public:
  explicit MeshTransmittance(const DisplayMesh& mesh);

  /// Returns whether light goes straight through some triangle.
  bool has_panes() const { return !panes_.empty(); }
  /// Returns the material of a triangle if light goes straight through some place of it, else null.
  const Material* pane(std::uint32_t triangle) const { return panes_.empty() ? nullptr : panes_[triangle]; }
  /// Returns the share of light, per band, that goes straight on at the point (1-u-v) a + u b + v c of a triangle, from either
  /// side: all of it at a hole, and zero unless the triangle is of a pane.
  Rgb at(std::uint32_t triangle, double u, double v) const;
  /// Returns whether a ray that meets the back of this triangle is dimmed there: it is of a pane that has no triangles for its
  /// other side. Holes alone do not make a pane: from behind, one-sided cards are not seen.
  bool dims_from_behind(std::uint32_t triangle) const {
    const Material* const material = pane(triangle);
    return material && !material->two_sided && !material->regular_transmittance.is_zero();
  }
  /// Returns the share of the surface at that point that is there and not cut out, in [0, 1].
  double opacity_at(std::uint32_t triangle, double u, double v) const;

 private:
  const DisplayMesh& mesh_;
  std::vector<const Material*> panes_;  // by triangle, see panes_of()
};

}  // namespace alvor
