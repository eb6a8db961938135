#pragma once
// Names of units in pictures and tables.

#include "meshing/scene.h"

namespace alvor {

constexpr const char* irradiance_unit(Quantity quantity) { return quantity == Quantity::photometric ? "lx" : "W/m2"; }

/// Returns what one number says about three bands: their mean, or in a photometric scene the luminous value (Rec. 709).
constexpr double one_number(const Rgb& bands, Quantity quantity) {
  return quantity == Quantity::photometric ? 0.2126 * bands.r + 0.7152 * bands.g + 0.0722 * bands.b : bands.mean();
}

}  // namespace alvor
