#pragma once
// Names of quantities and units in options, pictures, tables and files.

#include "meshing/scene.h"

#include <string_view>

namespace alvor {

constexpr const char* irradiance_unit(Quantity quantity) { return quantity == Quantity::photometric ? "lx" : "W/m2"; }

/// Returns the quantity's name in options and solution files.
constexpr const char* name_of(Quantity quantity) { return quantity == Quantity::photometric ? "photometric" : "radiometric"; }
/// Returns the quantity of a name; any other text than "photometric" is radiometric.
constexpr Quantity quantity_of(std::string_view name) {
  return name == name_of(Quantity::photometric) ? Quantity::photometric : Quantity::radiometric;
}

/// Returns what one number says about three bands: their mean, or in a photometric scene the luminous value (Rec. 709).
constexpr double one_number(const Rgb& bands, Quantity quantity) {
  return quantity == Quantity::photometric ? 0.2126 * bands.r + 0.7152 * bands.g + 0.0722 * bands.b : bands.mean();
}

}  // namespace alvor
