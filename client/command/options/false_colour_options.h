#pragma once
// Options for false colour.

#include "client/picture/camera.h"
#include "client/picture/false_colour.h"

#include <CLI/CLI.hpp>

#include <optional>
#include <string>

namespace alvor {

struct FalseColourOptions {
  bool wanted = false;        ///< irradiance
  std::string shown;          ///< irradiance or error; empty: not chosen
  std::string band = "mean";  ///< or r, g, b
  std::string range;          ///< two numbers; empty means automatic
  bool logarithmic = false;
};

/// Adds the options; those that ask for false colour exclude `exposure`.
void add_false_colour_options(CLI::App& command, FalseColourOptions& options, CLI::Option& exposure);

/// Returns the settings for a picture of `size`, or nothing unless false colour is wanted. Throws Failure (usage) if the range is
/// malformed, or options of false colour are given without it. If the picture is too small for a legend, leaves it out and warns
/// on stderr.
std::optional<FalseColour> false_colour_of(const FalseColourOptions& options, PictureSize size);

}  // namespace alvor
