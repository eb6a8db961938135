#pragma once

#include "solution/rgb.h"

#include <cstdint>

namespace alvor {

/// A root patch whose light is carried by exact form factors and shadow rays.
struct Emitter {
  std::uint32_t root = 0;
  Rgb emission;      ///< E, W/m2
  double power = 0;  ///< sum over bands of E times area, W
};

}  // namespace alvor
