#pragma once
// Converts radiosity in W/m2 to screen colours: exposure, filmic curve, sRGB.

#include "meshing/display_mesh.h"
#include "solution/rgb.h"

#include <cstdint>
#include <vector>

namespace alvor {

/// Returns the relative luminance of linear sRGB (Rec. 709 weights).
constexpr double luminance(const Rgb& a) { return 0.2126 * a.r + 0.7152 * a.g + 0.0722 * a.b; }

/// Returns whether a surface emits: more leaves it than it could reflect, as reflectance is below 1.
constexpr bool emits(const RgbF& radiosity, const RgbF& irradiance) {
  return radiosity.r > irradiance.r || radiosity.g > irradiance.g || radiosity.b > irradiance.b;
}

/// The brightness of a visible piece of surface, from which exposure is computed.
struct LitArea {
  double luminance = 0;
  double weight = 0;  ///< area on the surface or in the picture; any unit
  bool emitter = false;
};

/// Returns the exposure, a factor > 0, that shows the surfaces well: their logarithmic mean becomes a middle grey, unless bright
/// surfaces would then saturate. Emitters count only where nothing else is lit, and may saturate.
double automatic_exposure(std::vector<LitArea> areas);

/// Returns the exposure for a whole mesh, seen equally from all sides.
double automatic_exposure(const DisplayMesh& mesh);

/// Returns exposed radiosity mapped by a filmic curve: linear, in [0, 1].
Rgb tone_map(const Rgb& exposed);

/// Returns the sRGB byte of a linear value, clamped to [0, 1].
std::uint8_t srgb_byte(double linear);

}  // namespace alvor
