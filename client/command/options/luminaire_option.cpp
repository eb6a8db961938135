#include "client/command/options/luminaire_option.h"

#include "client/command/output/failure.h"
#include "client/command/output/numbers.h"
#include "import/base/import_error.h"
#include "import/base/scene_format.h"
#include "import/base/whole_file.h"

namespace alvor {

namespace {

void require_photometric(const std::filesystem::path& path) {
  if (!is_luminaire_extension(lower_case_extension(path)))
    throw Failure(ExitStatus::usage, path.string() + ": photometric files end in .ies or .ldt");
}

/// A luminaire of the command line.
struct Placed {
  std::filesystem::path file;
  std::vector<double> position, angles;  ///< x, y, z; turn, tilt, spin
};

Placed parse_placed(const std::string& text) {
  const auto at = text.rfind('@');
  if (at != text.npos && at > 0) {
    const std::string rest = text.substr(at + 1);
    const auto colon = rest.find(':');
    const auto position = parse_numbers(rest.substr(0, colon), 3);
    const auto angles = parse_numbers(colon == rest.npos ? "0,0,0" : rest.substr(colon + 1), 3);
    if (position && angles) return {text.substr(0, at), *position, *angles};
  }
  throw Failure(ExitStatus::usage, "--luminaire: '" + text + "' is not FILE@x,y,z or FILE@x,y,z:turn,tilt,spin");
}

}  // namespace

void add_luminaires(std::span<const std::string> texts, v1::ImportOptions& options, LightFiles& files) {
  for (const std::string& text : texts) {
    const Placed placed = parse_placed(text);
    require_photometric(placed.file);
    const std::string name = files.add(placed.file, "luminaire");
    v1::PlacedLuminaire& luminaire = *options.add_luminaires();
    luminaire.set_file(name);
    luminaire.mutable_position()->set_x(placed.position[0]);
    luminaire.mutable_position()->set_y(placed.position[1]);
    luminaire.mutable_position()->set_z(placed.position[2]);
    luminaire.set_turn_degrees(placed.angles[0]);
    luminaire.set_tilt_degrees(placed.angles[1]);
    luminaire.set_spin_degrees(placed.angles[2]);
  }
}

LuminaireFile read_luminaire_file(const std::filesystem::path& path) {
  require_photometric(path);
  try {
    return read_luminaire(read_whole_file(path), lower_case_extension(path));
  } catch (const FileError& error) {
    throw Failure(ExitStatus::bad_scene, error.what());
  } catch (const ImportError& error) {
    throw Failure(ExitStatus::bad_scene, path.string() + ": " + error.what());
  }
}

}  // namespace alvor
