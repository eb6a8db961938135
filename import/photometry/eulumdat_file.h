#pragma once

#include "import/photometry/luminaire_file.h"

#include <string_view>

namespace alvor {

/// Reads an EULUMDAT file (Stockmar 1990). Throws ImportError whose place is a line.
LuminaireFile read_eulumdat(std::string_view text);

}  // namespace alvor
