#pragma once
// From a place on a scale to a colour.

#include "solution/rgb.h"

namespace alvor {

/// Linear sRGB of `position`, clamped to [0, 1]. 0 is dark violet (sRGB 68, 1, 84), 1 bright yellow (253, 231, 37); by way of
/// blue and green, ever lighter, so that the order shows in grey and to the colour-blind too.
Rgb colour_map(double position);

/// For values of either sign: linear sRGB of `position`, clamped to [0, 1]. 0 is dark blue, 0.5 nearly white, 1 dark red.
Rgb diverging_colour_map(double position);

}  // namespace alvor
