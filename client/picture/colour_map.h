#pragma once
// Maps a position on a scale to a colour.

#include "solution/rgb.h"

namespace alvor {

/// Returns the linear sRGB colour at `position`, clamped to [0, 1]: from dark violet (sRGB 68, 1, 84) at 0 by way of blue and
/// green to bright yellow (253, 231, 37) at 1. Lightness increases throughout, so the order is visible in grey and to the
/// colour-blind too.
Rgb colour_map(double position);

/// Returns a colour for values of either sign, as linear sRGB. `position` is clamped to [0, 1]: 0 is dark blue, 0.5 nearly white,
/// 1 dark red.
Rgb diverging_colour_map(double position);

}  // namespace alvor
