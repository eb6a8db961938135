#pragma once
// Intersects single rays with triangles.

#include "meshing/vec3.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

namespace alvor {

/// Whether a ray may slip through the common edge of two triangles: rarely (`fast`) or never (`watertight`).
enum class Traversal { fast, watertight };

/// Tests one ray or one point at a time against triangles, for drawing, probing and verifying. Immutable; safe from any thread.
class TriangleCaster {
 public:
  /// Most triangles that callers let one ray pass. The time of a cast grows with their number: each hit is compared with all of
  /// them.
  static constexpr std::size_t most_passed = 1000;

  TriangleCaster(std::span<const Vec3> positions, std::span<const std::array<std::uint32_t, 3>> triangles,
                 Traversal traversal = Traversal::fast);
  ~TriangleCaster();
  TriangleCaster(const TriangleCaster&) = delete;
  TriangleCaster& operator=(const TriangleCaster&) = delete;

  /// A point of triangle `triangle`: (1-u-v) a + u b + v c. `distance` is that from the ray's origin, or from the point asked
  /// for, in the units of the positions.
  struct Hit {
    std::uint32_t triangle;
    double u, v;
    double distance;
  };
  /// Returns the nearest surface along `direction` (unit), front or back, that is none of the triangles `passed`.
  std::optional<Hit> cast(Vec3 origin, Vec3 direction, std::span<const std::uint32_t> passed = {}) const;
  /// Returns the nearest front along `direction` (unit) that is none of the triangles `passed`. The ray passes through backs: of
  /// two sides in one place it meets the one that faces it.
  std::optional<Hit> cast_front(Vec3 origin, Vec3 direction, std::span<const std::uint32_t> passed = {}) const;
  /// Returns whether a surface, front or back, lies between two points.
  bool is_blocked(Vec3 from, Vec3 to) const;
  /// Returns the point nearest to `point` on a triangle whose normal lies within 60 degrees of `normal` (unit).
  std::optional<Hit> nearest(Vec3 point, Vec3 normal) const;

 private:
  struct Handles;
  std::unique_ptr<Handles> handles_;
};

}  // namespace alvor
