#pragma once
// Where the sun stands, and how bright it is in a clear sky.

#include <cstdint>

namespace alvor {

/// A place on the Earth, degrees: north and east are positive.
struct Geolocation {
  double latitude = 0, longitude = 0;
  friend bool operator==(const Geolocation&, const Geolocation&) = default;
};

/// Where the sun stands in the sky, degrees. Without refraction, which lifts a sun at the horizon by half a degree.
struct SunPosition {
  double azimuth = 0;    ///< clockwise from north, in [0, 360)
  double elevation = 0;  ///< above the horizon, in [-90, 90]
  friend bool operator==(const SunPosition&, const SunPosition&) = default;
};

/// Returns where the sun stands, by the algorithm of the Astronomical Almanac as Michalsky (1988) gives it: within 0.01 degrees
/// from 1950 to 2050. `unix_seconds` is the time in seconds since 1970-01-01 00:00 UTC.
SunPosition sun_position(const Geolocation& place, double unix_seconds);

/// Illuminances under a clear sky by the IES recommendation (RP-21, 1984), lx.
struct ClearSky {
  double sun = 0;  ///< of a surface that faces the sun: 127500 exp(-0.21 / sin h)
  double sky = 0;  ///< of a horizontal surface, from the sky alone: 800 + 15500 sqrt(sin h)
};

/// Returns the illuminances for a sun at this elevation, degrees; 0 if it is below the horizon.
ClearSky clear_sky(double elevation);

}  // namespace alvor
