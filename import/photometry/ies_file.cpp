#include "import/photometry/ies_file.h"

#include "import/base/import_error.h"
#include "import/photometry/photometric_planes.h"
#include "import/photometry/photometric_text.h"

#include <algorithm>
#include <cmath>

namespace alvor {

namespace {

constexpr double metres_per_foot = 0.3048;
// Angles that symmetry decides are compared to this, degrees.
constexpr double angle_tolerance = 0.01;
// A luminaire that shines from a line is that wide, metres.
constexpr double width_of_line = 0.01;

bool is_near(double a, double b) { return std::abs(a - b) < angle_tolerance; }

std::string upper_case(std::string_view text) {
  std::string upper(text);
  std::ranges::transform(upper, upper.begin(), [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return upper;
}

/// Returns the edition that the version line names; empty if this is not a version line.
std::string edition_of(std::string_view line) {
  if (line.starts_with("IESNA91")) return "LM-63-1991";
  for (const std::string_view begin : {"IESNA:LM-63-", "IES:LM-63-"})
    if (line.starts_with(begin)) return "LM-63-" + std::string(line.substr(begin.size()).substr(0, 4));
  return {};
}

/// Keeps what the keywords "[LUMINAIRE] ..." and "[LUMCAT] ..." say.
void keep_name(std::string_view line, LuminaireFile& file) {
  for (const std::string_view keyword : {"[LUMINAIRE]", "[LUMCAT]"}) {
    if (!upper_case(line).starts_with(keyword)) continue;
    const auto first = line.find_first_not_of(" \t", keyword.size());
    if (first != line.npos && (file.name.empty() || keyword == "[LUMINAIRE]")) file.name = line.substr(first);
  }
}

/// Reads up to the line TILT= and returns what it says.
std::string read_labels(PhotometricText& text, LuminaireFile& file) {
  while (!text.is_at_end()) {
    const std::string_view line = text.line("line TILT=");
    if (file.format.empty()) file.format = edition_of(line);
    const std::string upper = upper_case(line);
    const auto equals = upper.starts_with("TILT") ? upper.find_first_not_of(" \t", 4) : upper.npos;
    if (equals != upper.npos && upper[equals] == '=') {
      const auto value = upper.find_first_not_of(" \t", equals + 1);
      if (file.format.empty()) file.format = "LM-63-1986";
      return value == upper.npos ? "NONE" : std::string(line.substr(value));
    }
    keep_name(line, file);
  }
  throw ImportError("file", "is not a luminaire: it has no line TILT=");
}

/// Returns the factor that the lamps' tilt brings where the luminaire hangs as it was measured.
double read_tilt(PhotometricText& text, const std::string& tilt, LuminaireFile& file) {
  if (upper_case(tilt) == "NONE") return 1;
  if (upper_case(tilt) != "INCLUDE") {
    file.warnings.push_back("the tilt file '" + tilt + "' is not read: the light is that of lamps at a tilt of 0");
    return 1;
  }
  text.number("lamp geometry");
  const std::size_t count = text.count("number of tilt angles", 1, most_angles);
  const std::vector<double> angles = text.numbers(count, "tilt angles"), factors = text.numbers(count, "tilt factors");
  const auto nearest = std::ranges::min_element(angles, {}, [](double angle) { return std::abs(angle); });
  const double factor = factors[static_cast<std::size_t>(nearest - angles.begin())];
  if (std::ranges::any_of(factors, [&](double other) { return other != factor; }))
    file.warnings.push_back("its lamps bring other light when tilted (TILT=INCLUDE): the factor of a tilt of 0 is used");
  return factor;
}

/// The luminous opening of the table in LM-63: negative sizes mean round shapes. Metres; `height` along the aim.
LuminousOpening opening_of(double width, double length, double height) {
  using Shape = LuminousOpening::Shape;
  const bool is_round = width < 0 || length < 0, lies = height < 0;
  double w = std::abs(width), l = std::abs(length);
  const double h = std::abs(height);
  if (w == 0 && l == 0 && h == 0) return {};
  if (is_round && w == 0) w = l;
  if (is_round && l == 0) l = w;
  if (is_round && lies && is_near(w, h) && is_near(l, h)) return {Shape::sphere, w, w, w};
  if (lies && w == 0) w = h;  // a tube that lies has one negative size, its diameter
  if (lies && l == 0) l = h;
  if (w == 0) w = width_of_line;
  if (l == 0) l = width_of_line;
  if (h == 0) return {is_round ? Shape::ellipse : Shape::rectangle, l, w, 0};
  return {is_round && !lies ? Shape::cylinder : Shape::box, l, w, h};
}

struct Table {
  std::vector<double> vertical, horizontal;
  std::vector<std::vector<float>> rows;  // by horizontal angle
};

Table read_table(PhotometricText& text, std::size_t verticals, std::size_t horizontals, double factor) {
  Table table;
  table.vertical = text.numbers(verticals, "vertical angles");
  table.horizontal = text.numbers(horizontals, "horizontal angles");
  for (std::size_t h = 0; h < horizontals; ++h) {
    std::vector<float>& row = table.rows.emplace_back();
    for (std::size_t v = 0; v < verticals; ++v) row.push_back(text.intensity(factor * text.number("intensities")));
  }
  return table;
}

void set_type_c(const Table& table, PhotometricWeb& web, LuminaireFile& file) {
  web.angles = table.vertical;
  std::vector<PhotometricPlane> planes;
  for (std::size_t h = 0; h < table.rows.size(); ++h) planes.push_back({table.horizontal[h], table.rows[h]});
  const double first = table.horizontal.front(), last = table.horizontal.back();
  PlaneMirrors mirrors;
  if (planes.size() == 1) file.symmetry = "axial";
  else if (is_near(first, 0) && is_near(last, 90)) file.symmetry = "quadrant", mirrors = {true, true};
  else if (is_near(first, 0) && is_near(last, 180)) file.symmetry = "bilateral", mirrors = {true, false};
  else if (is_near(first, 90) && is_near(last, 270)) file.symmetry = "bilateral", mirrors = {false, true};
  else if (is_near(first, 0) && last > 180 && last < 360 + angle_tolerance) file.symmetry = "none";
  else
    throw ImportError("horizontal angles", "go from " + std::to_string(first) + " to " + std::to_string(last) +
                                               " degrees, needs 0 to 0, 90, 180 or 360, or 90 to 270");
  complete(web, std::move(planes), mirrors);
}

/// Appends, before angles that begin at 0, the same with negative sign.
void mirror_at_zero(std::vector<double>& angles, std::vector<std::vector<float>>& rows) {
  const std::size_t count = angles.size();
  std::vector<double> all;
  std::vector<std::vector<float>> all_rows;
  for (std::size_t n = count; n-- > 1;) all.push_back(-angles[n]), all_rows.push_back(rows[n]);
  all.insert(all.end(), angles.begin(), angles.end());
  all_rows.insert(all_rows.end(), rows.begin(), rows.end());
  angles = std::move(all), rows = std::move(all_rows);
}

std::vector<std::vector<float>> transposed(const std::vector<std::vector<float>>& rows) {
  std::vector<std::vector<float>> columns(rows.front().size());
  for (const auto& row : rows)
    for (std::size_t v = 0; v < row.size(); ++v) columns[v].push_back(row[v]);
  return columns;
}

// The angle from the axis `across` is 90 degrees less the vertical angle.
void set_type_a_or_b(Table table, PhotometricWeb& web, LuminaireFile& file) {
  web.axis = PhotometricWeb::Axis::across;
  const bool is_mirrored_h = table.horizontal.size() > 1 && is_near(table.horizontal.front(), 0);
  if (is_mirrored_h) mirror_at_zero(table.horizontal, table.rows);
  auto columns = transposed(table.rows);
  const bool is_mirrored_v = is_near(table.vertical.front(), 0) && is_near(table.vertical.back(), 90);
  if (is_mirrored_v) mirror_at_zero(table.vertical, columns);
  file.symmetry = is_mirrored_h && is_mirrored_v ? "quadrant" : is_mirrored_h || is_mirrored_v ? "bilateral" : "none";
  std::ranges::reverse(columns);
  for (auto angle = table.vertical.rbegin(); angle != table.vertical.rend(); ++angle) web.angles.push_back(90 - *angle);
  web.planes = table.horizontal;
  for (const auto& row : transposed(columns)) web.intensities.insert(web.intensities.end(), row.begin(), row.end());
}

}  // namespace

LuminaireFile read_ies(std::string_view bytes) {
  PhotometricText text(bytes);
  LuminaireFile file;
  const std::string tilt = read_labels(text, file);
  const double tilt_factor = read_tilt(text, tilt, file);
  const double lamps = text.number("number of lamps"), lumens = text.number("lumens per lamp");
  const double multiplier = text.number("multiplier");
  const std::size_t verticals = text.count("number of vertical angles", 2, most_angles);
  const std::size_t horizontals = text.count("number of horizontal angles", 1, most_angles);
  text.require_table(horizontals, verticals);
  file.type = "CBA"[text.count("photometric type", 1, 3) - 1];
  const double metres = text.count("type of units", 1, 2) == 1 ? metres_per_foot : 1;
  const double width = text.number("width"), length = text.number("length"), height = text.number("height");
  file.opening = opening_of(metres * width, metres * length, metres * height);
  const double ballast = text.number("ballast factor");
  // From 2002 on the next number is not a factor: reserved, then (2019) a code of how the file was made.
  const double next = text.number("ballast-lamp factor");
  const double ballast_lamp = file.format < "LM-63-2002" ? next : 1;
  file.watts = std::max(0.0, text.number("input watts"));
  const double factor = multiplier * ballast * ballast_lamp * tilt_factor;
  if (!(factor > 0)) throw ImportError(text.place(), "multiplier and ballast factors give a product that is not positive");
  Table table = read_table(text, verticals, horizontals, factor);
  if (lumens >= 0) file.lamp_lumens = std::abs(lamps) * lumens * ballast * ballast_lamp;
  auto web = std::make_shared<PhotometricWeb>();
  if (file.type == 'C') set_type_c(table, *web, file);
  else set_type_a_or_b(std::move(table), *web, file);
  file.web = std::move(web);
  return file;
}

}  // namespace alvor
