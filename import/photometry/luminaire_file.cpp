#include "import/photometry/luminaire_file.h"

#include "import/base/import_error.h"
#include "import/photometry/eulumdat_file.h"
#include "import/photometry/ies_file.h"

#include <cmath>
#include <cstdio>

namespace alvor {

namespace {

// Integrated and stated lumens that differ by more are told.
constexpr double told_difference = 0.01;

void compare_lumens(LuminaireFile& file) {
  if (!file.stated_lumens) return;
  const double stated = *file.stated_lumens, difference = file.lumens / stated - 1;
  if (std::abs(difference) <= told_difference) return;
  char text[160];
  std::snprintf(text, sizeof text, "its intensities add up to %.5g lm, %+.1f %% of the %.5g lm that it states", file.lumens,
                100 * difference, stated);
  file.warnings.push_back(text);
}

}  // namespace

LuminaireFile read_luminaire(std::string_view bytes, const std::string& extension) {
  LuminaireFile file = extension == ".ldt" ? read_eulumdat(bytes) : read_ies(bytes);
  if (const auto fault = fault_in(*file.web)) throw ImportError("file", *fault);
  file.lumens = file.web->flux();
  if (!(file.lumens > 0)) throw ImportError("file", "the luminaire brings no light: all intensities are 0");
  compare_lumens(file);
  return file;
}

bool is_luminaire_extension(std::string_view extension) { return extension == ".ies" || extension == ".ldt"; }

}  // namespace alvor
