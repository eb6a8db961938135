#pragma once
// False colour, as options say.

#include "client/picture/camera.h"
#include "client/picture/false_colour.h"

#include <CLI/CLI.hpp>

#include <optional>
#include <string>

namespace alvor {

struct FalseColourOptions {
  bool wanted = false;
  std::string band = "mean";  ///< or r, g, b
  std::string range;          ///< two numbers; empty means automatic
  bool logarithmic = false;
};

/// Returns the option that asks for false colour.
CLI::Option* add_false_colour_options(CLI::App& command, FalseColourOptions& options);

/// What to draw in a picture of `size`, if it is wanted at all. Throws Failure (usage) if the range is none. Without a legend,
/// and with a warning on stderr, where the picture is too small for one.
std::optional<FalseColour> false_colour_of(const FalseColourOptions& options, PictureSize size);

}  // namespace alvor
