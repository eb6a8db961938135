#include "import/photometry/eulumdat_file.h"

#include "import/base/import_error.h"
#include "import/photometry/photometric_planes.h"
#include "import/photometry/photometric_text.h"

#include <algorithm>
#include <cmath>

namespace alvor {

namespace {

constexpr double metres_per_millimetre = 1e-3;
constexpr double intensities_per_lumens = 1e-3;  // intensities are cd per 1000 lm of the lamps
constexpr std::size_t most_lamp_sets = 20, direct_ratios = 10, lines_of_lamp_set = 6;

void skip(PhotometricText& text, std::size_t lines, const char* what) {
  for (std::size_t n = 0; n < lines; ++n) text.line(what);
}

/// The luminous opening: four heights for the sides of a box; width 0 means round. C0 is across the luminaire.
LuminousOpening read_opening(PhotometricText& text) {
  using Shape = LuminousOpening::Shape;
  const auto metres = [&](const char* what) { return metres_per_millimetre * std::max(0.0, text.number_line(what)); };
  const double along = metres("length of the luminous area"), across = metres("width of the luminous area");
  double height = 0;
  for (int side = 0; side < 4; ++side) height = std::max(height, metres("height of the luminous area"));
  if (along == 0) return {};
  if (across == 0) return {height > 0 ? Shape::cylinder : Shape::ellipse, along, along, height};
  return {height > 0 ? Shape::box : Shape::rectangle, across, along, height};
}

/// Returns the lumens of the first set of lamps.
double read_lamps(PhotometricText& text, LuminaireFile& file) {
  const std::size_t sets = text.count_line("number of lamp sets", 1, most_lamp_sets);
  text.line("number of lamps");
  text.line("type of lamps");
  const double lumens = std::abs(text.number_line("lumens of the lamps"));
  skip(text, 2, "colour of the lamps");
  file.watts = std::max(0.0, text.number_line("watts"));
  skip(text, (sets - 1) * lines_of_lamp_set, "further lamp sets");
  if (sets > 1) file.warnings.push_back("has " + std::to_string(sets) + " sets of lamps: the first counts");
  return lumens;
}

struct Symmetry {
  const char* name;
  PlaneMirrors mirrors;
  std::size_t first, count;  // planes in the file, of all
};

Symmetry symmetry_of(std::size_t number, std::size_t planes) {
  switch (number) {
    case 1: return {"axial", {}, 0, 1};
    case 2: return {"bilateral", {true, false}, 0, planes / 2 + 1};
    case 3: return {"bilateral", {false, true}, 3 * planes / 4, planes / 2 + 1};
    case 4: return {"quadrant", {true, true}, 0, planes / 4 + 1};
    default: return {"none", {}, 0, planes};
  }
}

}  // namespace

LuminaireFile read_eulumdat(std::string_view bytes) {
  PhotometricText text(bytes);
  LuminaireFile file;
  file.format = "EULUMDAT";
  text.line("company");
  text.count_line("type of luminaire", 0, 3);
  const std::size_t number = text.count_line("symmetry", 0, 4);
  const std::size_t planes = text.count_line("number of C planes", 1, most_angles);
  text.number_line("distance of C planes");
  const std::size_t angles = text.count_line("number of angles", 2, most_angles);
  text.require_table(planes, angles);
  skip(text, 2, "distance of angles");
  file.name = text.line("name");
  skip(text, 6, "sizes of the luminaire");
  file.opening = read_opening(text);
  text.line("downward flux");
  const double output_percent = text.number_line("light output ratio");
  const double conversion = text.number_line("conversion factor");
  if (text.number_line("tilt") != 0) file.warnings.push_back("was measured with a tilt, which is ignored");
  const double lamp_lumens = read_lamps(text, file);
  skip(text, direct_ratios, "direct ratios");

  const Symmetry symmetry = symmetry_of(number, planes);
  file.symmetry = symmetry.name;
  auto web = std::make_shared<PhotometricWeb>();
  std::vector<double> all_planes;
  for (std::size_t n = 0; n < planes; ++n) all_planes.push_back(text.number_line("C planes"));
  for (std::size_t n = 0; n < angles; ++n) web->angles.push_back(text.number_line("angles"));
  const double factor = (conversion > 0 ? conversion : 1) * lamp_lumens * intensities_per_lumens;
  if (!(factor > 0)) throw ImportError("lamps", "bring no light: their lumens are 0");
  std::vector<PhotometricPlane> given;
  for (std::size_t n = 0; n < symmetry.count; ++n) {
    PhotometricPlane& plane = given.emplace_back();
    plane.angle = all_planes[(symmetry.first + n) % planes];
    for (std::size_t a = 0; a < angles; ++a)
      plane.intensities.push_back(text.intensity(factor * text.number_line("intensities")));
  }
  complete(*web, std::move(given), symmetry.mirrors);
  file.lamp_lumens = lamp_lumens;
  if (output_percent > 0) file.stated_lumens = output_percent / 100 * lamp_lumens;
  file.web = std::move(web);
  return file;
}

}  // namespace alvor
