// The page of a report: HTML with its pictures in it.

#include "client/report/report.h"

#include "client/picture/round_number.h"
#include "client/picture/units.h"

#include <absl/strings/escaping.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <initializer_list>
#include <span>

namespace alvor {

namespace {

constexpr const char* style = R"(
body { font: 11pt/1.45 sans-serif; color: #222; max-width: 48em; margin: 2em auto; padding: 0 1em; }
h1 { font-size: 1.6em; margin-bottom: 0; } h2 { font-size: 1.25em; margin-top: 2em; border-bottom: 1px solid #bbb; }
table { border-collapse: collapse; margin: 0.8em 0; } td, th { padding: 0.2em 0.9em 0.2em 0; text-align: left; vertical-align: top; }
th { font-weight: 600; } td.n, th.n { text-align: right; } thead th { border-bottom: 1px solid #888; }
img { max-width: 100%; } .plan { page-break-inside: avoid; } small, .small { color: #555; font-size: 0.9em; }
@page { size: A4; margin: 16mm; } tr { page-break-inside: avoid; }
@media print { body { margin: 0; max-width: none; } h2 { page-break-after: avoid; } }
)";

/// Returns a text with the characters that mean something in HTML replaced.
std::string escaped(std::string_view text) {
  std::string safe;
  for (const char c : text) switch (c) {
      case '&': safe += "&amp;"; break;
      case '<': safe += "&lt;"; break;
      case '>': safe += "&gt;"; break;
      case '"': safe += "&quot;"; break;
      default: safe += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
    }
  return safe;
}

std::string text_of(const char* format, double value) {
  char text[48];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

/// Returns an illuminance with no more digits than it deserves.
std::string light_text(double value) { return value >= 100 ? text_of("%.0f", value) : text_of("%.3g", value); }
std::string percent_text(double share) { return text_of("%.2g", 100 * share) + " %"; }
std::string metres_text(double metres) { return text_of("%.2f", metres) + " m"; }
std::string measured_text(const Measured& measured) {
  return light_text(measured.value) + " &plusmn; " + text_of("%.2g", measured.error);
}

/// Returns U0 of a work plane, and a dash where the plane has no light.
std::string uniformity_text(const PlaneStatistics& plane) {
  return plane.mean.value > 0 ? text_of("%.2f", plane.uniformity()) : "&ndash;";
}
std::string flux_text(double flux) { return flux >= 1000 ? text_of("%.0f", flux) : text_of("%.4g", flux); }

/// A table of HTML. Cells are HTML.
class Table {
 public:
  explicit Table(std::initializer_list<const char*> heads) {
    if (heads.size() == 0) return;
    html_ += "<thead><tr>";
    bool is_first = true;
    for (const char* head : heads) html_ += std::string(is_first ? "<th>" : "<th class=n>") + head + "</th>", is_first = false;
    html_ += "</tr></thead>";
  }
  /// Adds a row of a name and numbers.
  void row(std::initializer_list<std::string> cells) {
    html_ += "<tr>";
    bool is_first = true;
    for (const std::string& cell : cells)
      html_ += (is_first ? "<th>" : "<td class=n>") + cell + (is_first ? "</th>" : "</td>"), is_first = false;
    html_ += "</tr>\n";
  }
  std::string html() const { return "<table>" + html_ + "</table>\n"; }

 private:
  std::string html_;
};

/// Writes one report.
class Page {
 public:
  explicit Page(const Report& report) : report_(report), unit_(irradiance_unit(report.quantity)) {}

  std::string html() const {
    std::string page = "<!doctype html>\n<html lang=en><head><meta charset=utf-8><title>" + escaped(report_.title) +
                       "</title><style>" + style + "</style></head><body>\n<h1>" + escaped(report_.title) + "</h1>\n";
    page += "<p>" + introduction() + "</p>\n" + overview();
    for (std::size_t n = 0; n < report_.rooms.size(); ++n) page += room(report_.rooms[n], report_.plans[n]);
    page += luminaires() + surfaces() + method();
    if (!report_.source.empty()) page += "<p class=small>" + escaped(report_.source) + "</p>\n";
    return page + "</body></html>\n";
  }

 private:
  bool is_photometric() const { return report_.quantity == Quantity::photometric; }

  std::string introduction() const {
    std::string text = is_photometric() ? "Illuminance" : "Irradiance";
    text += " on work planes " + metres_text(report_.options.heights.work) + " above the floor, without a strip of " +
            metres_text(report_.options.border) +
            " along the walls, or of 15 % of a room's width where that is less, at grid points as in EN 12464-1. ";
    const double factor = report_.options.maintenance_factor;
    text += factor == 1 ? "Maintenance factor 1: values are initial ones."
                        : "Maintenance factor " + text_of("%.2g", factor) + ": values are maintained ones; glare is initial.";
    return text;
  }

  std::string overview() const {
    Table table{"room", "area", "mean", "minimum", "U<sub>0</sub>", is_photometric() ? "highest UGR" : "", "W/m&sup2;"};
    for (const RoomReport& room : report_.rooms) {
      const bool has_light = room.horizontal.has_value();
      table.row({escaped(room.room.name), text_of("%.1f", room.room.area) + " m&sup2;",
                 has_light ? light_text(room.horizontal->mean.value) + " " + unit_ : "&ndash;",
                 has_light ? light_text(room.horizontal->minimum) + " " + unit_ : "&ndash;",
                 has_light ? uniformity_text(*room.horizontal) : "&ndash;", highest_glare(room), power_density(room)});
    }
    return table.html();
  }

  static std::string highest_glare(const RoomReport& room) {
    std::optional<double> highest;
    for (const ObservedGlare& seen : room.glare)
      if (seen.glare && seen.glare->rating) highest = std::max(highest.value_or(-100), *seen.glare->rating);
    return highest ? text_of("%.1f", *highest) : "";
  }

  static std::string power_density(const RoomReport& room) {
    if (!room.power.is_complete || room.power.luminaires == 0) return "&ndash;";
    return text_of("%.2f", room.power.watts / room.room.area);
  }

  std::string room(const RoomReport& room, const std::string& plan) const {
    std::string html = "<h2>" + escaped(room.room.name) + "</h2>\n";
    html += "<div class=plan><img alt=\"plan\" src=\"data:image/png;base64," + absl::Base64Escape(plan) +
            "\"></div>\n<p class=small>Plan from above; numbers at the grid points in " + unit_ +
            ", curves at the values of the legend, luminaires in red. Grey: the strip along the walls, and places inside of "
            "solids.</p>\n";
    return html + figures(room) + glare(room) + daylight(room);
  }

  std::string figures(const RoomReport& room) const {
    Table table{};
    table.row({"Floor between the walls", text_of("%.2f", room.room.area) + " m&sup2;"});
    if (std::isfinite(room.room.clear_height)) table.row({"Clear height", metres_text(room.room.clear_height)});
    table.row({"Grid", std::to_string(room.grid.columns) + " &times; " + std::to_string(room.grid.rows) + " points, " +
                           metres_text(room.grid.spacing_u) + " &times; " + metres_text(room.grid.spacing_v)});
    if (room.horizontal) {
      const PlaneStatistics& plane = *room.horizontal;
      table.row({"Mean", measured_text(plane.mean) + " " + unit_});
      table.row({"Minimum", light_text(plane.minimum) + " " + unit_});
      table.row({"Maximum", light_text(plane.maximum) + " " + unit_});
      table.row({"Uniformity U<sub>0</sub> (minimum / mean)", uniformity_text(plane)});
    }
    if (room.cylindrical)
      table.row({"Cylindrical, mean at " + metres_text(report_.options.heights.face),
                 measured_text(room.cylindrical->mean) + " " + unit_});
    add_power(room, table);
    return table.html();
  }

  void add_power(const RoomReport& room, Table& table) const {
    if (!room.power.is_complete || room.power.luminaires == 0) return;
    const double density = room.power.watts / room.room.area;
    table.row({"Electrical power", text_of("%.4g", room.power.watts) + " W in " + std::to_string(room.power.luminaires) +
                                       (room.power.luminaires == 1 ? " luminaire" : " luminaires")});
    table.row({"Power density", text_of("%.2f", density) + " W/m&sup2;"});
    if (is_photometric() && room.horizontal && room.horizontal->mean.value > 0)
      table.row({"Power density per 100 lx", text_of("%.2f", 100 * density / room.horizontal->mean.value) + " W/m&sup2;"});
  }

  static std::string glare(const RoomReport& room) {
    if (room.glare.empty()) return "";
    Table table{"observer (eye)", "looks along", "UGR", "L<sub>b</sub>, cd/m&sup2;"};
    for (const auto& [observer, glare] : room.glare)
      table.row({triple(observer.eye), triple(observer.forward),
                 !glare                  ? "inside a solid"
                 : glare->rating         ? text_of("%.1f", *glare->rating)
                 : glare->background > 0 ? "no luminaire in view"
                                         : "the background is dark",
                 glare ? text_of("%.3g", glare->background) : ""});
    return "<h3>Glare</h3>\n" + table.html();
  }

  static std::string triple(const Vec3& v) {
    const auto number = [](double x) { return text_of("%.2f", std::abs(x) < 0.005 ? 0 : x); };
    return number(v.x) + ", " + number(v.y) + ", " + number(v.z);
  }

  static std::string daylight(const RoomReport& room) {
    if (!room.daylight) return "";
    Table table{};
    table.row({"Median (on half of the points)", percent_text(room.daylight->median)});
    table.row({"On 95 % of the points", percent_text(room.daylight->on_95_percent)});
    table.row({"Mean", percent_text(room.daylight->mean)});
    table.row({"Minimum", percent_text(room.daylight->minimum)});
    return "<h3>Daylight factor</h3>\n" + table.html();
  }

  std::string luminaires() const {
    if (report_.luminaires.empty() && report_.emitting.empty()) return "";
    const std::string light = is_photometric() ? "lm" : "W of light";
    Table table{"luminaire", "number", light.c_str(), "W", is_photometric() ? "lm/W" : ""};
    for (const LuminaireType& type : report_.luminaires) {
      const bool has_watts = type.electrical_watts > 0;
      table.row({escaped(type.name), std::to_string(type.count), flux_text(type.lumens),
                 has_watts ? text_of("%.4g", type.electrical_watts) : "&ndash;",
                 has_watts && is_photometric() ? text_of("%.3g", type.lumens / type.electrical_watts) : ""});
    }
    for (const EmittingMaterial& material : report_.emitting)
      table.row({"surface '" + escaped(material.name) + "', " + text_of("%.3g", material.area) + " m&sup2;", "",
                 flux_text(material.lumens), "&ndash;", ""});
    std::string html = "<h2>Luminaires</h2>\n" + table.html() +
                       "<p class=small>Light and power of one luminaire; of surfaces the area and the light of all together, "
                       "with both sides of those that have two.</p>\n";
    if (report_.has_distant_light) html += "<p>A sun, a sky or an environment shines, too.</p>\n";
    return html;
  }

  std::string surfaces() const {
    if (report_.surfaces.empty()) return "";
    constexpr std::size_t most = 20;
    Table table{"material", "reflectance", "area"};
    for (const SurfaceMaterial& material : std::span(report_.surfaces).first(std::min(most, report_.surfaces.size())))
      table.row({escaped(material.name), text_of("%.2f", material.reflectance), text_of("%.1f", material.area) + " m&sup2;"});
    std::string html = "<h2>Surfaces</h2>\n" + table.html();
    if (report_.surfaces.size() > most)
      html += "<p class=small>And " + std::to_string(report_.surfaces.size() - most) + " materials of smaller areas.</p>\n";
    return html;
  }

  std::string method() const {
    std::string html =
        "<h2>Method</h2>\n<p>Radiosity: all surfaces reflect diffusely, and light is exchanged between them until it changes no "
        "more. At each grid point the light of luminaires is computed exactly or by shadow rays, that of surfaces by 4096 rays "
        "into the solution. What follows &plusmn; is one standard error: noise of these rays, and the solution's own error at "
        "the surfaces that they meet, as if all of these erred alike.";
    if (is_photometric()) html += " UGR: CIE 117:1995 with Guth's position index; windows and skies belong to the background.";
    html += "</p>\n<ul>\n";
    if (report_.told_error)
      html += "<li>The solution tells an error of " + percent_text(*report_.told_error) +
              " (RMS over all surfaces, relative to their mean light).</li>\n";
    if (report_.verification && report_.verification->errors.points > 0) {
      const ErrorStatistics& errors = report_.verification->errors;
      html += "<li>Compared with independent path tracing at " + std::to_string(errors.points) + " points of the surfaces (" +
              std::to_string(report_.verification->paths) + " paths each): RMS error " + percent_text(errors.nrmse.value) +
              " (95 %: " + percent_text(errors.nrmse.low) + " to " + percent_text(errors.nrmse.high) + "), mean " +
              text_of("%+.2g", 100 * errors.bias.value) + " %.</li>\n";
    } else {
      html += "<li>Not compared with path tracing.</li>\n";
    }
    for (const std::string& remark : report_.remarks) html += "<li>" + escaped(remark) + "</li>\n";
    return html + "</ul>\n";
  }

  const Report& report_;
  const std::string unit_;
};

}  // namespace

std::string report_page(const Report& report) { return Page(report).html(); }

}  // namespace alvor
