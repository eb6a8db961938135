#pragma once
// Sun, sky and ground, which shine on a scene from infinitely far away.

#include "meshing/light.h"
#include "meshing/scene.h"
#include "meshing/sun_position.h"

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace alvor {

/// Says where the sun stands by place and time.
struct SunTime {
  Geolocation place;
  double unix_seconds = 0;  ///< since 1970-01-01 00:00 UTC
  friend bool operator==(const SunTime&, const SunTime&) = default;
};

/// Which sun, sky and ground a scene has.
struct Daylight {
  enum class Sky : std::uint8_t {
    none,
    uniform,
    overcast,  ///< that of Moon and Spencer
    cie,       ///< a CIE standard general sky (ISO 15469:2004)
    perez,     ///< that of Perez et al. (1993)
  };
  /// The sun's place in the sky; std::monostate means that there is no sun. CIE and Perez skies need one.
  std::variant<std::monostate, SunPosition, SunTime> sun;
  std::optional<double> sun_irradiance;  ///< of a surface that faces the sun, W/m2 or lx; nothing: by a model
  Sky sky = Sky::none;
  int cie_number = 0;                    ///< cie: 1 to 15
  double direct_normal_watts = 0;        ///< perez: W/m2, >= 0
  double diffuse_horizontal_watts = 0;   ///< perez: W/m2, > 0
  std::optional<double> sky_irradiance;  ///< of an open horizontal surface from the sky alone, W/m2 or lx; nothing: by a model
  double ground_reflectance = 0;         ///< of a ground beyond the scene, in [0, 1]
  double north_degrees = 0;              ///< clockwise seen from above, from -z (z up: from y) to north

  friend bool operator==(const Daylight&, const Daylight&) = default;
};

/// Lumens per watt of daylight, as in Radiance.
constexpr double usual_lumens_per_watt = 179;

/// Returns where the sun stands; nothing if there is none.
std::optional<SunPosition> position_of_sun(const Daylight& wanted);

/// Returns which value is out of range or does not fit to the others, as the end of a sentence about the daylight.
std::optional<std::string> fault_in(const Daylight& wanted);

/// Returns the lights "sun", "sky" and "ground", those that there are, in this order. A sun at or below the horizon, or of
/// less than 1e-6 W/m2 or lx, does not shine, and a ground shines only if something lights it. What is not given comes from the
/// IES model of a clear sky (sun, and CIE skies 11 to 15), from the values of Perez, or is 10 000 lx of a cloudy sky.
/// `lumens_per_watt` converts what the models say for scenes of the other quantity. Requires: !fault_in(wanted).
std::vector<Light> lights_of(const Daylight& wanted, Quantity quantity, UpAxis up, double lumens_per_watt);

}  // namespace alvor
