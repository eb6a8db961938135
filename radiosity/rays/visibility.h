#pragma once
// Rays against surfaces. The only file that names Embree is visibility.cpp.

#include "meshing/base_mesh.h"

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

namespace alvor {

/// Sixteen rays, traversed together; struct of arrays as SIMD wants it. Local coordinates (see LocalFrame).
struct alignas(64) RayPacket {
  static constexpr int width = 16;
  float origin_x[width], origin_y[width], origin_z[width];
  float direction_x[width], direction_y[width], direction_z[width];  ///< need not be unit
  float t_min[width], t_max[width];
};

/// What a packet hit. `root` is `nothing` where a ray left the scene; otherwise u, v are the root patch's coordinates as
/// Embree gives them (exact for triangles and parallelograms, see PatchPlace for other quads).
struct alignas(64) HitPacket {
  static constexpr std::uint32_t nothing = ~0u;
  std::uint32_t root[RayPacket::width];
  float u[RayPacket::width], v[RayPacket::width];
  float t[RayPacket::width];
};

/// Maps metres to the solver's frame: the scene's centre at 0 and its longest side 1, so that float32 traversal sees
/// neither the units nor the origin.
struct LocalFrame {
  Vec3 centre;
  double metres_per_unit = 1;
  Vec3 to_local(Vec3 p) const { return (p - centre) / metres_per_unit; }
};

/// All root patches but the backs of two-sided faces (a hit from behind belongs to the twin), in local coordinates. Immutable;
/// any number of threads may trace at a time.
class Visibility {
 public:
  Visibility(std::span<const RootPatch> roots, const LocalFrame& frame);
  ~Visibility();
  Visibility(const Visibility&) = delete;
  Visibility& operator=(const Visibility&) = delete;

  void closest_hits(std::span<const RayPacket> packets, std::span<HitPacket> hits) const;
  /// Bit i of `blocked[p]` is set where ray i of packet p meets a surface between t_min and t_max.
  void occlusions(std::span<const RayPacket> packets, std::span<std::uint16_t> blocked) const;

 private:
  struct Handles;
  std::unique_ptr<Handles> handles_;
};

/// Whether a ray may slip through the common edge of two triangles: rarely, where it must be fast, or never.
enum class Traversal { fast, watertight };

/// One ray or one point at a time against plain triangles, for drawing, probing and verifying. Immutable; safe from any thread.
class TriangleCaster {
 public:
  TriangleCaster(std::span<const Vec3> positions, std::span<const std::array<std::uint32_t, 3>> triangles,
                 Traversal traversal = Traversal::fast);
  ~TriangleCaster();
  TriangleCaster(const TriangleCaster&) = delete;
  TriangleCaster& operator=(const TriangleCaster&) = delete;

  /// A point of triangle `triangle`: (1-u-v) a + u b + v c. `distance` is in the positions' units, along the ray or through
  /// space.
  struct Hit {
    std::uint32_t triangle;
    double u, v;
    double distance;
  };
  /// Nearest surface along `direction` (unit), front or back.
  std::optional<Hit> cast(Vec3 origin, Vec3 direction) const;
  /// Nearest front along `direction` (unit). Backs are passed through, so that of two sides in one place the one that looks
  /// against the ray is met.
  std::optional<Hit> cast_front(Vec3 origin, Vec3 direction) const;
  /// Whether a surface, front or back, lies between two points.
  bool is_blocked(Vec3 from, Vec3 to) const;
  /// Nearest point of a surface whose normal lies within 60 degrees of `normal` (unit).
  std::optional<Hit> nearest(Vec3 point, Vec3 normal) const;

 private:
  struct Handles;
  std::unique_ptr<Handles> handles_;
};

}  // namespace alvor
