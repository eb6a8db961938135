#pragma once
// Luminaires that the command line adds to a scene.

#include "import/luminaire_file.h"
#include "meshing/scene.h"

#include <filesystem>
#include <string>

namespace alvor {

/// A luminaire of the command line: FILE@x,y,z[:turn,tilt,spin].
struct LuminairePlace {
  std::filesystem::path file;
  Vec3 position;                        ///< metres
  double turn = 0, tilt = 0, spin = 0;  ///< degrees
};

/// Throws Failure (usage) unless `text` says a file and a place.
LuminairePlace parse_luminaire_place(const std::string& text);

/// Reads a photometric file. Throws Failure (bad_scene) that names the file, the line and the reason.
LuminaireFile read_luminaire_file(const std::filesystem::path& path);

/// Returns the light at its place. Without angles it shines straight down and its plane C0 points along x. `spin` turns it about
/// its own aim, then `tilt` turns the aim from straight down towards x, then `turn` turns it about the vertical; the first and
/// last counter-clockwise seen from above.
Light hang(const LuminaireFile& file, const LuminairePlace& place, UpAxis up);

}  // namespace alvor
