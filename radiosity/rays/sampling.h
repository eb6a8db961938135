#pragma once
// Where rays start and go. Everything is a function of the seed.

#include "meshing/patch_place.h"
#include "solution/patch_id.h"

#include <array>
#include <cstdint>
#include <vector>

namespace alvor {

/// Rays of one origin are one packet; the directions of an origin are stratified 4 x 4 over the hemisphere's disk, those of all
/// the origins of a patch together 16 x 16 ((0,2)-sequence, Sobol 1967).
inline constexpr int rays_per_origin = 16;
inline constexpr int origins_per_patch = 16;
inline constexpr int rays_per_row = rays_per_origin * origins_per_patch;

/// Uniform numbers in [0, 1) from a patch's own stream.
class RandomStream {
 public:
  RandomStream(std::uint64_t seed, PatchId patch) : state_(mix_bits(seed ^ mix_bits(patch.bits()))) {}
  double next() { return static_cast<double>(next_bits() >> 11) * 0x1p-53; }
  std::uint32_t next_below(std::uint32_t n) { return static_cast<std::uint32_t>((next_bits() >> 32) * n >> 32); }

 private:
  std::uint64_t next_bits() { return mix_bits(state_ += 0x9e3779b97f4a7c15u); }
  std::uint64_t state_;
};

/// How the rays of an origin are spread over its hemisphere.
enum class RayPlacing {
  nusselt,   ///< cosine-distributed: uniform points of the unit disk, lifted to the hemisphere (Nusselt 1928); all weigh the same
  hemicube,  ///< one through each of sixteen cells of a hemicube, weighted by its delta form factor (Cohen & Greenberg 1985)
};

/// Directions about the normal. Several independently scrambled sets of rays_per_row each; origin o uses the directions
/// [16 o, 16 o + 16), whose weights have the mean 1.
class DirectionSets {
 public:
  static constexpr int set_count = 32;
  struct alignas(64) Set {
    std::array<float, rays_per_row> x, y, z;  ///< z along the normal, > 0
    std::array<float, rays_per_row> weight;
  };

  explicit DirectionSets(std::uint64_t seed, RayPlacing placing = RayPlacing::nusselt);
  bool has_weights() const { return placing_ == RayPlacing::hemicube; }  ///< otherwise all are 1
  const Set& operator[](std::uint32_t n) const { return sets_[n]; }

 private:
  RayPlacing placing_;
  std::vector<Set> sets_;
};

/// Strata of a patch form a chessboard. Its white fields: half of the strata, with the same mean position as the other half.
constexpr bool is_white(int origin) { return ((origin ^ origin >> 1) & 1) == 0; }

/// A point in each of the patch's 16 strata (its grandchildren): the middle, moved by `jitter` in [-1/2, 1/2)^2 of the stratum on
/// white fields and against it on black ones, so that the mean of all sixteen stays in the middle.
struct OriginPlaces {
  std::array<float, origins_per_patch> u, v;
};
OriginPlaces origins_in(const PatchShape& patch, Uv jitter);

/// Point n of the (0,2)-sequence, digits scrambled by `scramble_u`, `scramble_v`.
Uv sobol_point(std::uint32_t n, std::uint32_t scramble_u, std::uint32_t scramble_v);

}  // namespace alvor
