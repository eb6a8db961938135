#pragma once
// Places meshes in a scene by node transforms.

#include "meshing/scene.h"

#include <cstdint>
#include <span>

namespace alvor {

/// An affine map, given by the images of the axes and of the origin. The identity changes no bit of a point.
struct Placement {
  Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1}, origin;

  Vec3 direction(Vec3 d) const { return d.x * x + d.y * y + d.z * z; }
  Vec3 point(Vec3 p) const { return direction(p) + origin; }
  /// Returns whether the map turns counter-clockwise into clockwise.
  bool mirrors() const { return dot(cross(x, y), z) < 0; }
};

/// Returns the map that applies `inner`, then `outer`.
Placement operator*(const Placement& outer, const Placement& inner);

/// Appends the placed vertices and returns the index of the first. Throws ImportError when instances of meshes add up to too many
/// vertices: a file of a few kilobytes can ask for any number.
std::uint32_t add_placed_vertices(Scene& scene, std::span<const Vec3> vertices, const Placement& placement);

/// Appends a face. Reverses its corners if the placement mirrors, so that its front stays its front. Throws ImportError when
/// there are too many.
void add_placed_face(Scene& scene, std::span<const std::uint32_t> polygon, std::uint32_t material, const Placement& placement);

/// Adds the grey material for faces that name none, and returns its index.
std::uint32_t add_default_material(Scene& scene);

/// Reflectance of a material that gives none.
inline constexpr Rgb default_reflectance{0.5, 0.5, 0.5};

}  // namespace alvor
