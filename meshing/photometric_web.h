#pragma once
// The luminous intensity of a luminaire by direction, as photometric files give it.

#include "meshing/vec3.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace alvor {

/// Intensities on a grid of directions, bilinear in the angles between them. A direction is told by its angle from a polar axis,
/// and by the half plane through that axis in which it lies. Immutable once made.
struct PhotometricWeb {
  static constexpr std::size_t most_intensities =
      200'000;  ///< goniometers measure at 361 x 181 angles at most; a web is sent in one message
  /// Which axis of the luminaire the half planes share.
  enum class Axis : unsigned char {
    aim,     ///< the main direction (C planes: type C of LM-63, EULUMDAT)
    across,  ///< the axis `across`, perpendicular to it (types A and B of LM-63)
  };
  Axis axis = Axis::aim;
  /// Degrees, ascending. About the aim: from `across` counter-clockwise as the lamp is seen from behind; one plane stands for all
  /// (rotational symmetry), else the first is 0 and the last 360. About `across`: from the aim, clockwise as seen from the end of
  /// `across`, within [-180, 180]; outside of the planes there is no light.
  std::vector<double> planes;
  /// Degrees from the polar axis, ascending, within [0, 180]. Outside of them there is no light.
  std::vector<double> angles;
  std::vector<float> intensities;  ///< cd or W/sr, >= 0; `angles` of the first plane, then of the next

  /// Returns the intensity in a direction with these coordinates: along `across`, along the axis that is perpendicular to both
  /// (aim cross `across` points the opposite way), along the aim. Requires: a unit vector; !fault_in(web).
  double intensity(Vec3 direction) const;
  /// Returns the integral of the intensity over all directions, lm or W. Exact for the bilinear intensities.
  double flux() const;
  float greatest() const;

  friend bool operator==(const PhotometricWeb&, const PhotometricWeb&) = default;

 private:
  double at(double plane, double angle) const;
};

/// Returns why the web cannot be used; nothing if it can.
std::optional<std::string> fault_in(const PhotometricWeb& web);

}  // namespace alvor
