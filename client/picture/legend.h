#pragma once
// Draws the legend of a false-colour picture, which tells the values of the colours.

#include "client/picture/camera.h"
#include "client/picture/colour_map.h"
#include "client/picture/colour_scale.h"
#include "client/picture/png_file.h"
#include "client/picture/text.h"

#include <string>
#include <vector>

namespace alvor {

struct Legend {
  ColourScale scale;
  std::vector<std::string> title;  ///< lines above the bar; the unit is the last
  bool values_below = false;       ///< values beyond an end occur; the end's label says so
  bool values_above = false;
  Rgb (*colours)(double position) = colour_map;  ///< colour map of the bar
  Colour paper{36, 36, 36}, ink{225, 225, 225};
};

/// A number beside the bar.
struct LegendLabel {
  double position = 0;  ///< 0 at the bar's foot, 1 at its top
  std::string text;
};

/// Returns the labels from the foot up: the ends of the scale, and the round numbers between that keep `least_distance` from the
/// others. Requires: 0 < least_distance <= 1.
std::vector<LegendLabel> labels_of(const Legend& legend, double least_distance);

/// Returns the pixels that a legend adds to the width of a picture of this height.
int legend_width(int picture_height);

/// Returns whether a picture of this size has room for a legend and a view.
bool legend_fits(PictureSize picture);

/// Returns `view` with the legend at its right, wider by legend_width. Labels of very many digits cover a little of the view.
Image with_legend(const Image& view, const Legend& legend);

}  // namespace alvor
