#pragma once
// Sun, sky and ground that the command line adds to a scene.

#include "alvor/v1/scene_service.pb.h"

#include <CLI/CLI.hpp>

#include <optional>
#include <string>

namespace alvor {

struct SkyOptions {
  std::string sun;                  ///< AZIMUTH,ELEVATION in degrees
  std::string place;                ///< LATITUDE,LONGITUDE in degrees
  std::string time;                 ///< ISO 8601 with Z or an offset
  std::string sky;                  ///< uniform, overcast, clear, cie1 ... cie15, perez:DIRECT,DIFFUSE
  std::optional<double> sun_light;  ///< of a surface that faces the sun, W/m2 or lx
  std::optional<double> sky_light;  ///< of an open horizontal surface, from the sky alone, W/m2 or lx
  double ground = 0;                ///< reflectance
  double north = 0;                 ///< degrees, clockwise seen from above: from -z (y is up) or y (z is up) to north
};

void add_sky_options(CLI::App& command, SkyOptions& options);

/// Returns what the options say; nothing if they say nothing. Throws Failure (usage) for options that do not fit together.
std::optional<v1::Daylight> daylight_of(const SkyOptions& options);

}  // namespace alvor
