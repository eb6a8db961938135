#pragma once

#include "solution/rgb.h"

#include <cstdint>

namespace alvor {

/// A root patch whose light is carried by exact form factors and shadow rays.
struct Emitter {
  std::uint32_t root = 0;
  Rgb emission;      ///< E per band, emission units (see EmissionUnit)
  double power = 0;  ///< E times area, summed over bands; emission units times m2
};

}  // namespace alvor
