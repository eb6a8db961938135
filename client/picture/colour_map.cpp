#include "client/picture/colour_map.h"

#include "solution/srgb.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace alvor {
namespace {

/// Colours at equal steps of position, sRGB bytes, after viridis (van der Walt and Smith 2015); steps of lightness are equal too.
constexpr std::array<Rgb, 11> anchors{{{68, 1, 84},
                                       {72, 36, 117},
                                       {65, 68, 135},
                                       {53, 95, 141},
                                       {42, 120, 142},
                                       {33, 145, 140},
                                       {34, 168, 132},
                                       {68, 191, 112},
                                       {122, 209, 81},
                                       {189, 223, 38},
                                       {253, 231, 37}}};

/// Colours at equal steps of position, sRGB bytes, after RdBu (Brewer and Harrower 2003), from blue to red: safe for the
/// colour-blind.
constexpr std::array<Rgb, 11> diverging_anchors{{{5, 48, 97},
                                                 {33, 102, 172},
                                                 {67, 147, 195},
                                                 {146, 197, 222},
                                                 {209, 229, 240},
                                                 {247, 247, 247},
                                                 {253, 219, 199},
                                                 {244, 165, 130},
                                                 {214, 96, 77},
                                                 {178, 24, 43},
                                                 {103, 0, 31}}};

double linear_of(double srgb_byte) { return linear_of_srgb(srgb_byte / 255); }

Rgb between(const std::array<Rgb, 11>& colours, double position) {
  const double place = std::clamp(position, 0.0, 1.0) * (colours.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(place), colours.size() - 2);
  const double share = place - static_cast<double>(below);
  const Rgb mixed = (1 - share) * colours[below] + share * colours[below + 1];
  return {linear_of(mixed.r), linear_of(mixed.g), linear_of(mixed.b)};
}

}  // namespace

Rgb colour_map(double position) { return between(anchors, position); }

Rgb diverging_colour_map(double position) { return between(diverging_anchors, position); }

}  // namespace alvor
