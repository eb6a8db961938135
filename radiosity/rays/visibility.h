#pragma once
// Intersects packets of rays with the root patches of a mesh.

#include "meshing/base_mesh.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace alvor {

/// Sixteen rays that are traversed together, as a struct of arrays for SIMD. Local coordinates (see LocalFrame).
struct alignas(64) RayPacket {
  static constexpr int width = 16;
  float origin_x[width], origin_y[width], origin_z[width];
  float direction_x[width], direction_y[width], direction_z[width];  ///< need not be unit
  float t_min[width], t_max[width];

  /// Sets a ray that begins at `from` and ends where it has gone `end` times `way`.
  void set(std::size_t lane, Vec3 from, Vec3 way, float end) {
    origin_x[lane] = static_cast<float>(from.x), direction_x[lane] = static_cast<float>(way.x);
    origin_y[lane] = static_cast<float>(from.y), direction_y[lane] = static_cast<float>(way.y);
    origin_z[lane] = static_cast<float>(from.z), direction_z[lane] = static_cast<float>(way.z);
    t_min[lane] = 0, t_max[lane] = end;
  }
};

/// The hits of a packet of rays. `root` is `nothing` where a ray left the scene. Otherwise u, v are Embree's coordinates on the
/// root patch: exact for triangles and parallelograms; LocalScene::places_of_hits converts them for other quads. t is the
/// distance along the ray in lengths of its direction.
struct alignas(64) HitPacket {
  static constexpr std::uint32_t nothing = ~0u;
  std::uint32_t root[RayPacket::width];
  float u[RayPacket::width], v[RayPacket::width];
  float t[RayPacket::width];
};

/// A face that lets light straight through, where a ray of a packet crossed it on its way. u, v and t as in HitPacket. Whole
/// holes are not crossings.
struct Crossing {
  std::uint32_t lane = 0, root = 0;
  float u = 0, v = 0, t = 0;
  float opacity = 1;  ///< share of the surface that is there
};

/// Maps metres to local coordinates: the scene's centre is 0 and its longest side 1, so that float32 traversal depends neither on
/// the units nor on the origin of the scene.
struct LocalFrame {
  Vec3 centre;
  double metres_per_unit = 1;
  Vec3 to_local(Vec3 p) const { return (p - centre) / metres_per_unit; }
  Vec3 to_metres(Vec3 p) const { return centre + metres_per_unit * p; }
};

/// Embree's scene of all root patches in local coordinates, without the backs of two-sided faces (a hit from behind belongs to
/// the twin). Rays go on through panes (Material::is_pane), from either side, but where what is there of a pane lets none
/// through. Immutable; any number of threads may trace at a time. Borrows the mesh.
class Visibility {
 public:
  Visibility(const BaseMesh& mesh, const LocalFrame& frame);
  ~Visibility();
  Visibility(Visibility&&) noexcept;
  Visibility& operator=(Visibility&&) noexcept;

  /// Writes the nearest hit of every ray on a face through which it does not go on, between its t_min and t_max, to `hits`.
  /// Writes the panes that the rays of packet p crossed before, ordered by lane and then along the ray, to `crossings[p]`, unless
  /// `crossings` is empty.
  void closest_hits(std::span<const RayPacket> packets, std::span<HitPacket> hits,
                    std::span<std::vector<Crossing>> crossings = {}) const;
  /// The share of light that the panes on the way of each ray of a packet let through, per band.
  using Tints = std::array<RgbF, RayPacket::width>;
  /// Sets bit i of `blocked[p]` if ray i of packet p meets a face through which it does not go on between its t_min and t_max,
  /// and clears it otherwise. Sets `tints[p]` unless `tints` is empty; the tint of a blocked ray is arbitrary.
  void occlusions(std::span<const RayPacket> packets, std::span<std::uint16_t> blocked, std::span<Tints> tints = {}) const;

 private:
  struct Handles;
  std::unique_ptr<Handles> handles_;
};

}  // namespace alvor
