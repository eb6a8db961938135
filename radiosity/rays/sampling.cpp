#include "radiosity/rays/sampling.h"

#include "radiosity/rays/hemicube.h"
#include "radiosity/rays/unit_disk.h"

#include <bit>
#include <cmath>

namespace alvor {

namespace {

std::uint32_t reverse_bits(std::uint32_t x) {
  x = (x >> 16) | (x << 16);
  x = ((x & 0xff00ff00u) >> 8) | ((x & 0x00ff00ffu) << 8);
  x = ((x & 0xf0f0f0f0u) >> 4) | ((x & 0x0f0f0f0fu) << 4);
  x = ((x & 0xccccccccu) >> 2) | ((x & 0x33333333u) << 2);
  return ((x & 0xaaaaaaaau) >> 1) | ((x & 0x55555555u) << 1);
}

/// Returns the second coordinate of point n of the Sobol sequence, as bits (Kollig & Keller 2002).
std::uint32_t sobol_second(std::uint32_t n) {
  std::uint32_t result = 0;
  for (std::uint32_t v = 1u << 31; n != 0; n >>= 1, v ^= v >> 1)
    if (n & 1) result ^= v;
  return result;
}

/// Exchanges each bit or not, as a hash of the lower bits and `seed` says (Laine & Karras 2011, with the constants of Vegdahl
/// 2021).
std::uint32_t exchange_by_lower_bits(std::uint32_t x, std::uint32_t seed) {
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16) | 1;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return x;
}

void set_direction(DirectionSets::Set& set, std::size_t n, Vec3 direction, double weight) {
  set.x[n] = static_cast<float>(direction.x);
  set.y[n] = static_cast<float>(direction.y);
  set.z[n] = static_cast<float>(direction.z);
  set.weight[n] = static_cast<float>(weight);
}

void place_on_disk(DirectionSets::Set& set, std::uint64_t scramble) {
  for (std::uint32_t n = 0; n < rays_per_row; ++n) {
    const DiskPoint d =
        concentric_disk(sobol_point(n, static_cast<std::uint32_t>(scramble), static_cast<std::uint32_t>(scramble >> 32)));
    set_direction(set, n, {d.x, d.y, std::sqrt(std::max(1e-12, 1 - d.x * d.x - d.y * d.y))}, 1);
  }
}

/// Returns a random point of the cell, distributed as the form factor density, by rejection. The cell's exact delta form factor
/// is then the right weight of the ray through the point.
Vec3 point_in(const Hemicube::Cell& cell, RandomStream& random) {
  const auto density = [](Vec3 p) { return p.z / (dot(p, p) * dot(p, p)); };
  // Upper bound of the density z / r^4 on the sides: its maximum is 0.3248, at z^2 = 1 / 3 in the middle. On the top it is 1.
  constexpr double most_on_sides = 0.33;
  const double most = cell.side_s.z == 0 && cell.side_t.z == 0 ? 1 : most_on_sides;
  for (;;) {
    const Vec3 p = cell.corner + random.next() * cell.side_s + random.next() * cell.side_t;
    if (random.next() * most <= density(p)) return p;
  }
}

void place_on_hemicubes(DirectionSets::Set& set, std::uint64_t scramble) {
  constexpr HemicubeGrid grid{4, 2, 2, 1};
  const Hemicube cube(grid);
  RandomStream random(scramble, PatchId::root(0));
  for (std::size_t n = 0; n < rays_per_row; ++n) {
    const Hemicube::Cell& cell = cube.cells()[n % rays_per_origin];
    set_direction(set, n, normalized(point_in(cell, random)), rays_per_origin * cell.delta);
  }
}

}  // namespace

Uv sobol_point(std::uint32_t n, std::uint32_t scramble_u, std::uint32_t scramble_v) {
  return {(reverse_bits(n) ^ scramble_u) * 0x1p-32, (sobol_second(n) ^ scramble_v) * 0x1p-32};
}

Uv owen_point(std::uint32_t n, std::uint32_t seed_u, std::uint32_t seed_v) {
  const std::uint32_t u = reverse_bits(exchange_by_lower_bits(n, seed_u));
  const std::uint32_t v = reverse_bits(exchange_by_lower_bits(reverse_bits(sobol_second(n)), seed_v));
  return {u * 0x1p-32, v * 0x1p-32};
}

DirectionSets::DirectionSets(std::uint64_t seed, RayPlacing placing) : placing_(placing), sets_(set_count) {
  for (int s = 0; s < set_count; ++s) {
    const std::uint64_t scramble = mix_bits(seed + 0x9e3779b97f4a7c15u * static_cast<std::uint64_t>(s + 1));
    if (placing == RayPlacing::nusselt) place_on_disk(sets_[s], scramble);
    else place_on_hemicubes(sets_[s], scramble);
  }
}

Strata::Strata(int corner_count, int along_u) {
  const PatchShape whole = PatchShape::whole(0, corner_count, along_u);
  for (int o = 0; o < origins_per_patch; ++o) {
    const Uv middle = whole.stratum_centre(o);
    u[o] = static_cast<float>(middle.u);
    v[o] = static_cast<float>(middle.v);
    // The inner one of the four parts of a triangle is turned.
    const bool is_turned = corner_count == 3 && ((o >> 2) == 3) != ((o & 3) == 3);
    const double sign = is_white(o) != is_turned ? 1 : -1;
    sway_u[o] = static_cast<float>(sign / along_u);
    sway_v[o] = static_cast<float>(sign * along_u / origins_per_patch);
  }
}

const Strata& Strata::of(const PatchShape& patch) {
  static const Strata triangle(3, 4);
  static const std::array<Strata, 5> quad{Strata(4, 1), Strata(4, 2), Strata(4, 4), Strata(4, 8), Strata(4, 16)};
  if (patch.corner_count == 3) return triangle;
  return quad[static_cast<std::size_t>(std::countr_zero(static_cast<std::uint32_t>(patch.strata_along_u)))];
}

OriginPlaces origins_in(const PatchShape& patch, Uv jitter) {
  const Strata& strata = Strata::of(patch);
  // Share of the jitter that keeps a point in its stratum. In a triangle 2/3 + room <= 1 must hold for u + v, so room <= 1/3.
  const double room = patch.corner_count == 3 ? 0.3 : 1;
  const auto size_u = static_cast<float>(double(patch.size_u) / grid_size),
             size_v = static_cast<float>(double(patch.size_v) / grid_size);
  const auto first_u = static_cast<float>(double(patch.first.i) / grid_size);
  const auto first_v = static_cast<float>(double(patch.first.j) / grid_size);
  const auto move_u = static_cast<float>(room * jitter.u), move_v = static_cast<float>(room * jitter.v);
  OriginPlaces places;
  for (int o = 0; o < origins_per_patch; ++o) {
    places.u[o] = first_u + size_u * (strata.u[o] + move_u * strata.sway_u[o]);
    places.v[o] = first_v + size_v * (strata.v[o] + move_v * strata.sway_v[o]);
  }
  return places;
}

}  // namespace alvor
