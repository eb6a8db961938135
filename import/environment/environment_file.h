#pragma once
// Reads files of environment maps.

#include "meshing/environment_map.h"

#include <string>
#include <string_view>
#include <vector>

namespace alvor {

/// Size to which larger images are reduced before anything else looks at them: the sun is 3 pixels wide.
inline constexpr std::uint32_t working_columns = 2048, working_rows = 1024;

struct EnvironmentFile {
  EnvironmentMap map;                 ///< at most working_columns x working_rows; values as in the file, not negative
  std::vector<std::string> warnings;  ///< negative values, a black image
};

/// Reads an equirectangular image. It must be twice as wide as high, within 2 %, and have at most 16384 x 8192 pixels, which is
/// known before memory is taken for them. Values are finite and at most 1e30; negative ones count as 0. Throws ImportError that
/// names the place. Requires: is_environment_extension(extension).
EnvironmentFile read_environment(const std::string& bytes, std::string_view extension);

}  // namespace alvor
