#pragma once
// Draws the luminous intensity of a luminaire by direction.

#include "client/picture/png_file.h"
#include "import/photometry/luminaire_file.h"

namespace alvor {

/// Returns the polar curves of a luminaire as data sheets show them: the aim points down, the distance from the middle is the
/// intensity in cd. Solid: the plane of C 0 and 180 degrees; dashed: that of 90 and 270 degrees.
Image draw_polar_curves(const LuminaireFile& luminaire);

}  // namespace alvor
