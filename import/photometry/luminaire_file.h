#pragma once
// Reads photometric files of luminaires: IES LM-63 (1986, 1991, 1995, 2002, 2019) and EULUMDAT.

#include "meshing/light.h"

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace alvor {

/// A luminaire as its photometric file describes it. Photometric: intensities in cd.
struct LuminaireFile {
  std::string format;    ///< "LM-63-2002", "EULUMDAT", ...
  std::string name;      ///< what the file calls it; may be empty
  char type = 'C';       ///< photometry type: C, B or A
  std::string symmetry;  ///< "axial", "quadrant", "bilateral", "none"
  std::shared_ptr<const PhotometricWeb> web;
  LuminousOpening opening;
  double lumens = 0;                    ///< integral of the intensities
  std::optional<double> lamp_lumens;    ///< of its bare lamps, as stated; none: absolute photometry
  std::optional<double> stated_lumens;  ///< that leave the luminaire, as stated
  double watts = 0;                     ///< 0: not stated
  std::vector<std::string> warnings;    ///< one sentence each
};

/// Reads a photometric file; `extension` (".ies", ".ldt") tells the format. Throws ImportError whose place is a line.
LuminaireFile read_luminaire(std::string_view bytes, const std::string& extension);

/// Returns whether files with this extension, in lower case with its dot, are photometric files.
bool is_luminaire_extension(std::string_view extension);

}  // namespace alvor
