#pragma once
// From radiosity in W/m2 to what a screen shows: exposure, filmic curve, sRGB.

#include "meshing/display_mesh.h"
#include "solution/rgb.h"

#include <cstdint>
#include <vector>

namespace alvor {

/// Relative luminance of linear sRGB (Rec. 709 weights).
constexpr double luminance(const Rgb& a) { return 0.2126 * a.r + 0.7152 * a.g + 0.0722 * a.b; }

/// More leaves than could be reflected: reflectance is below 1, so something is emitted here.
constexpr bool emits(const RgbF& radiosity, const RgbF& irradiance) {
  return radiosity.r > irradiance.r || radiosity.g > irradiance.g || radiosity.b > irradiance.b;
}

/// What is seen of a surface, for exposure.
struct LitArea {
  double luminance = 0;
  double weight = 0;  ///< area on the surface or in the picture; any unit
  bool emitter = false;
};

/// The factor that shows the surfaces well: their logarithmic mean becomes a middle grey, unless the bright ones would burn out.
/// Emitters count only where nothing else is lit, and may saturate. Greater than 0, whatever the areas.
double automatic_exposure(std::vector<LitArea> areas);

/// The same for a whole mesh, every side of it seen alike.
double automatic_exposure(const DisplayMesh& mesh);

/// Exposed radiosity through a filmic curve: linear, in [0, 1].
Rgb tone_map(const Rgb& exposed);

/// Linear [0, 1] to an sRGB byte.
std::uint8_t srgb_byte(double linear);

}  // namespace alvor
