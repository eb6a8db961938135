#pragma once
// Surfaces coloured by the irradiance that arrives at them: what can be asked for.

#include "client/picture/colour_scale.h"
#include "solution/rgb.h"

#include <optional>
#include <string>
#include <vector>

namespace alvor {

enum class Band { mean, red, green, blue };

struct FalseColour {
  Band band = Band::mean;
  std::optional<ColourScale> scale;  ///< automatic_scale of what is seen when empty; give one to pictures that are compared
  bool logarithmic = false;          ///< the automatic scale
  bool legend = true;                ///< draw one beside the view
};

double value_of(const RgbF& bands, Band band);

/// The unit, under the name of the band unless that is the mean.
std::vector<std::string> legend_title(Band band);

}  // namespace alvor
