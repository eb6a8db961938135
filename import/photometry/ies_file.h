#pragma once

#include "import/photometry/luminaire_file.h"

#include <string_view>

namespace alvor {

/// Reads a file of ANSI/IES LM-63. Throws ImportError whose place is a line.
LuminaireFile read_ies(std::string_view text);

}  // namespace alvor
