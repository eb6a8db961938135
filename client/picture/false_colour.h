#pragma once
// Options of a false-colour picture, which colours surfaces by their irradiance.

#include "client/picture/colour_scale.h"
#include "meshing/scene.h"
#include "solution/rgb.h"

#include <optional>
#include <string>
#include <vector>

namespace alvor {

enum class Band { mean, red, green, blue };
/// The quantity that the colours show: irradiance, or its told error (DisplayMesh::errors), which has no bands.
enum class Shown { irradiance, error };

struct FalseColour {
  Band band = Band::mean;
  std::optional<ColourScale> scale;  ///< empty: automatic_scale of the visible values; give one to compare pictures
  bool logarithmic = false;          ///< makes the automatic scale logarithmic
  bool legend = true;                ///< draw one beside the view
  Shown shown = Shown::irradiance;
};

/// Band::mean is the luminous value in a photometric scene.
double value_of(const RgbF& bands, Band band, Quantity quantity);

/// Returns the lines above the legend's bar: "error" or the name of the band, unless it is the mean, and the unit.
std::vector<std::string> legend_title(const FalseColour& options, Quantity quantity);

}  // namespace alvor
