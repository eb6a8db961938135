#include "radiosity/sampling.h"

#include <cmath>
#include <numbers>

namespace alvor {

namespace {

std::uint32_t reverse_bits(std::uint32_t x) {
  x = (x >> 16) | (x << 16);
  x = ((x & 0xff00ff00u) >> 8) | ((x & 0x00ff00ffu) << 8);
  x = ((x & 0xf0f0f0f0u) >> 4) | ((x & 0x0f0f0f0fu) << 4);
  x = ((x & 0xccccccccu) >> 2) | ((x & 0x33333333u) << 2);
  return ((x & 0xaaaaaaaau) >> 1) | ((x & 0x55555555u) << 1);
}

/// Second dimension of the Sobol sequence (Kollig & Keller 2002).
std::uint32_t sobol_second(std::uint32_t n) {
  std::uint32_t result = 0;
  for (std::uint32_t v = 1u << 31; n != 0; n >>= 1, v ^= v >> 1)
    if (n & 1) result ^= v;
  return result;
}

struct Disk {
  double x, y;
};
/// Area-preserving and of low distortion (Shirley & Chiu 1997).
Disk concentric_disk(Uv p) {
  const double a = 2 * p.u - 1, b = 2 * p.v - 1;
  if (a == 0 && b == 0) return {0, 0};
  const double quarter = std::numbers::pi / 4;
  const bool wide = std::abs(a) > std::abs(b);
  const double r = wide ? a : b, phi = wide ? quarter * b / a : quarter * (2 - a / b);
  return {r * std::cos(phi), r * std::sin(phi)};
}

}  // namespace

Uv sobol_point(std::uint32_t n, std::uint32_t scramble_u, std::uint32_t scramble_v) {
  return {(reverse_bits(n) ^ scramble_u) * 0x1p-32, (sobol_second(n) ^ scramble_v) * 0x1p-32};
}

DirectionSets::DirectionSets(std::uint64_t seed) : sets_(set_count) {
  for (int s = 0; s < set_count; ++s) {
    const std::uint64_t scramble = mix_bits(seed + 0x9e3779b97f4a7c15u * static_cast<std::uint64_t>(s + 1));
    for (std::uint32_t n = 0; n < rays_per_row; ++n) {
      const Disk d =
          concentric_disk(sobol_point(n, static_cast<std::uint32_t>(scramble), static_cast<std::uint32_t>(scramble >> 32)));
      sets_[s].x[n] = static_cast<float>(d.x);
      sets_[s].y[n] = static_cast<float>(d.y);
      sets_[s].z[n] = static_cast<float>(std::sqrt(std::max(1e-12, 1 - d.x * d.x - d.y * d.y)));
    }
  }
}

Uv origin_in(const PatchShape& patch, int origin, Uv jitter) {
  const PatchShape stratum = patch.child(origin >> 2).child(origin & 3);
  if (stratum.corner_count == 3 && jitter.u + jitter.v > 1) jitter = {1 - jitter.u, 1 - jitter.v};
  return {(stratum.first.i + jitter.u * stratum.size) / grid_size, (stratum.first.j + jitter.v * stratum.size) / grid_size};
}

}  // namespace alvor
