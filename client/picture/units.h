#pragma once
// Names of quantities and units in options, pictures, tables and files.

#include "meshing/scene.h"

#include <array>
#include <cstddef>
#include <string_view>

namespace alvor {

constexpr const char* irradiance_unit(Quantity quantity) { return quantity == Quantity::photometric ? "lx" : "W/m2"; }

/// Returns the quantity's name in options and solution files.
constexpr const char* name_of(Quantity quantity) { return quantity == Quantity::photometric ? "photometric" : "radiometric"; }
/// Returns the quantity of a name; any other text than "photometric" is radiometric.
constexpr Quantity quantity_of(std::string_view name) {
  return name == name_of(Quantity::photometric) ? Quantity::photometric : Quantity::radiometric;
}

/// Names of LuminousOpening::Shape in files and tables, in the order of its values.
inline constexpr std::array names_of_shapes{"point", "rectangle", "ellipse", "box", "cylinder", "sphere"};

constexpr const char* name_of(LuminousOpening::Shape shape) { return names_of_shapes[static_cast<std::size_t>(shape)]; }

/// Returns what one number says about three bands: their mean, or in a photometric scene the luminous value (Rec. 709).
constexpr double one_number(const Rgb& bands, Quantity quantity) {
  return quantity == Quantity::photometric ? 0.2126 * bands.r + 0.7152 * bands.g + 0.0722 * bands.b : bands.mean();
}

}  // namespace alvor
