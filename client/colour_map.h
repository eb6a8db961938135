#pragma once
// From a place on a scale to a colour.

#include "solution/rgb.h"

namespace alvor {

/// Linear sRGB of `position`, clamped to [0, 1]. 0 is dark violet (sRGB 68, 1, 84), 1 bright yellow (253, 231, 37); by way of
/// blue and green, ever lighter, so that the order shows in grey and to the colour-blind too.
Rgb colour_map(double position);

}  // namespace alvor
