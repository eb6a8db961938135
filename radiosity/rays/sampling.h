#pragma once
// Origins and directions of rays. All of them are functions of the seed.

#include "meshing/patch_place.h"
#include "solution/patch_id.h"

#include <array>
#include <cstdint>
#include <vector>

namespace alvor {

/// Numbers of rays and origins. The rays of one origin are one packet. Their directions are stratified 4 x 4 over the
/// hemisphere's disk; those of all origins of a patch together are stratified 16 x 16 ((0,2)-sequence, Sobol 1967).
inline constexpr int rays_per_origin = 16;
inline constexpr int origins_per_patch = strata_per_patch;
inline constexpr int rays_per_row = rays_per_origin * origins_per_patch;

/// Pseudo-random numbers that depend on a seed and a patch only.
class RandomStream {
 public:
  RandomStream(std::uint64_t seed, PatchId patch) : state_(mix_bits(seed ^ mix_bits(patch.bits()))) {}
  /// Returns a uniform number in [0, 1).
  double next() { return static_cast<double>(next_bits() >> 11) * 0x1p-53; }
  /// Returns a uniform integer in [0, n).
  std::uint32_t next_below(std::uint32_t n) { return static_cast<std::uint32_t>((next_bits() >> 32) * n >> 32); }

 private:
  std::uint64_t next_bits() { return mix_bits(state_ += 0x9e3779b97f4a7c15u); }
  std::uint64_t state_;
};

/// How the rays of an origin are spread over its hemisphere.
enum class RayPlacing {
  nusselt,   ///< cosine-distributed: uniform points of the unit disk, lifted to the hemisphere (Nusselt 1928); all weights are 1
  hemicube,  ///< one ray through each of sixteen cells of a hemicube, weighted by the cell's delta form factor (Cohen & Greenberg
             ///< 1985)
};

/// Ray directions about the normal: independently scrambled sets of rays_per_row directions each. Origin o uses the directions
/// [16 o, 16 o + 16) of a set, whose weights have the mean 1.
class DirectionSets {
 public:
  static constexpr int set_count = 32;  ///< a row picks one of these sets at random. Chosen; half: error -4 %, rays +2 %, double:
                                        ///< error +5 %, rays -9 % (docs/design/constants.md)
  struct alignas(64) Set {
    std::array<float, rays_per_row> x, y, z;  ///< z along the normal, > 0
    std::array<float, rays_per_row> weight;
  };

  explicit DirectionSets(std::uint64_t seed, RayPlacing placing = RayPlacing::nusselt);
  bool has_weights() const { return placing_ == RayPlacing::hemicube; }  ///< false: all weights are 1
  const Set& operator[](std::uint32_t n) const { return sets_[n]; }

 private:
  RayPlacing placing_;
  std::vector<Set> sets_;
};

/// Returns whether the stratum of `origin` is white. Two of the four strata of each quarter are white and two are black, in
/// whatever rows they lie (see PatchShape::stratum_centre), and white and black ones have the same mean position.
constexpr bool is_white(int origin) { return ((origin ^ origin >> 1) & 1) == 0; }

/// The middles of the strata of a patch that is its whole root, and the signed distances (`sway`) by which a jitter of 1 moves
/// them.
struct Strata {
  std::array<float, origins_per_patch> u, v, sway_u, sway_v;
  /// Returns the strata of a root with the patch's corners and numbers of strata.
  static const Strata& of(const PatchShape& patch);

 private:
  Strata(int corner_count, int along_u);
};

/// Points in the 16 strata of a patch, as coordinates (u, v) of its root.
struct OriginPlaces {
  std::array<float, origins_per_patch> u, v;
};
/// Returns a point in each stratum of the patch: the stratum's middle, moved by `jitter` times the stratum's size on white fields
/// and by the opposite on black ones, so that the mean of all sixteen stays in the patch's middle. Requires: jitter in [-1/2,
/// 1/2)^2.
OriginPlaces origins_in(const PatchShape& patch, Uv jitter);

/// Returns point n of the (0,2)-sequence, its binary digits scrambled (exclusive or) by `scramble_u` and `scramble_v`.
Uv sobol_point(std::uint32_t n, std::uint32_t scramble_u, std::uint32_t scramble_v);

/// Returns point n of the (0,2)-sequence, each of its binary digits exchanged or not at random by all digits before it (Owen
/// 1995). Points that are alike in their first digits are then random to each other, which sobol_point() leaves as they are.
Uv owen_point(std::uint32_t n, std::uint32_t seed_u, std::uint32_t seed_v);

}  // namespace alvor
