#include "client/report/report.h"

#include "client/picture/units.h"

#include <nlohmann/json.hpp>

#include <cmath>
#include <cstdio>
#include <string_view>

namespace alvor {

namespace {

using Json = nlohmann::ordered_json;

Json json_of(const Vec3& v) { return {v.x, v.y, v.z}; }
Json json_of(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }
Json json_of(const Measured& measured) { return {{"value", measured.value}, {"standard_error", measured.error}}; }

Json json_of(const std::optional<PlaneStatistics>& plane) {
  if (!plane) return nullptr;
  return {{"points", plane->points},
          {"mean", json_of(plane->mean)},
          {"minimum", plane->minimum},
          {"maximum", plane->maximum},
          {"uniformity", plane->uniformity()}};
}

Json json_of(const ObservedGlare& seen) {
  return {{"eye", json_of(seen.observer.eye)},
          {"forward", json_of(seen.observer.forward)},
          {"ugr", seen.glare ? json_of(seen.glare->rating) : Json(nullptr)},
          {"background_luminance", seen.glare ? Json(seen.glare->background) : Json(nullptr)}};
}

Json json_of(const DaylightFactors& factors) {
  return {
      {"mean", factors.mean}, {"minimum", factors.minimum}, {"median", factors.median}, {"on_95_percent", factors.on_95_percent}};
}

Json json_of(const RoomReport& report) {
  const Room& room = report.room;
  Json json{{"name", room.name},
            {"area_m2", room.area},
            {"floor_height_m", room.floor_height},
            {"clear_height_m", std::isfinite(room.clear_height) ? Json(room.clear_height) : Json(nullptr)},
            {"grid",
             {{"columns", report.grid.columns},
              {"rows", report.grid.rows},
              {"spacing_m", {report.grid.spacing_u, report.grid.spacing_v}},
              {"points", report.grid.points.size()}}},
            {"horizontal", json_of(report.horizontal)},
            {"cylindrical", json_of(report.cylindrical)},
            {"luminaires", report.power.luminaires}};
  json["electrical_watts"] = report.power.is_complete && report.power.luminaires > 0 ? Json(report.power.watts) : Json(nullptr);
  json["glare"] = Json::array();
  for (const ObservedGlare& seen : report.glare) json["glare"].push_back(json_of(seen));
  json["daylight_factor"] = report.daylight ? json_of(*report.daylight) : Json(nullptr);
  return json;
}

Json json_of(const LuminaireType& type, const char* light) {
  return {{"name", type.name},
          {"count", type.count},
          {light, type.lumens},
          {"electrical_watts", type.electrical_watts > 0 ? Json(type.electrical_watts) : Json(nullptr)}};
}

Json verification_json(const Verification& verification) {
  const auto interval = [](const Confidence& confidence) {
    return Json{{"value", confidence.value}, {"low", confidence.low}, {"high", confidence.high}};
  };
  return {{"points", verification.errors.points},
          {"paths_per_point", verification.paths},
          {"nrmse", interval(verification.errors.nrmse)},
          {"bias", interval(verification.errors.bias)}};
}

std::string number(double value) {
  if (!std::isfinite(value)) return "";
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}
std::string number(const std::optional<double>& value) { return value ? number(*value) : ""; }

/// Returns a text as a field of a CSV file. Spreadsheets would take a text that begins with some signs for a formula.
std::string field(const std::string& text) {
  std::string quoted = !text.empty() && std::string_view("=+-@").find(text[0]) != std::string_view::npos ? "\"'" : "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + '"';
}

std::string joined(const std::vector<std::string>& fields) {
  std::string line;
  for (const std::string& each : fields) line += (line.empty() ? "" : ",") + each;
  return line + '\n';
}

std::string room_line(const RoomReport& report) {
  const auto& plane = report.horizontal;
  const bool has_power = report.power.is_complete && report.power.luminaires > 0;
  std::optional<double> worst;
  for (const ObservedGlare& seen : report.glare)
    if (seen.glare && seen.glare->rating) worst = std::max(worst.value_or(-1e9), *seen.glare->rating);
  return joined({field(report.room.name), number(report.room.area), std::to_string(plane ? plane->points : 0),
                 plane ? number(plane->mean.value) : "", plane ? number(plane->mean.error) : "",
                 plane ? number(plane->minimum) : "", plane ? number(plane->maximum) : "",
                 plane ? number(plane->uniformity()) : "", report.cylindrical ? number(report.cylindrical->mean.value) : "",
                 number(worst), has_power ? number(report.power.watts) : "",
                 report.daylight ? number(report.daylight->median) : "",
                 report.daylight ? number(report.daylight->on_95_percent) : ""});
}

std::string point_line(const RoomReport& report, std::size_t n, double height) {
  const WorkPoint& at = report.grid.points[n];
  const PointLight& light = report.light[n];
  const Vec3 place = report.room.frame.place(at.along_u, at.along_v, report.room.floor_height + height);
  std::vector<std::string> fields{field(report.room.name), number(place.x), number(place.y), number(place.z)};
  for (const auto& measured : {light.horizontal, light.cylindrical}) {
    fields.push_back(measured ? number(measured->value) : "");
    fields.push_back(measured ? number(measured->error) : "");
  }
  for (const auto& vertical : light.vertical) fields.push_back(number(vertical));
  fields.push_back(report.daylight ? number(report.daylight->at_points[n]) : "");
  return joined(fields);
}

}  // namespace

std::string report_json(const Report& report) {
  const bool is_photometric = report.quantity == Quantity::photometric;
  const char* const light = is_photometric ? "lumens" : "watts_of_light";
  const ReportOptions& options = report.options;
  Json json{{"title", report.title},
            {"quantity", name_of(report.quantity)},
            {"unit", irradiance_unit(report.quantity)},
            {"work_plane_height_m", options.heights.work},
            {"face_height_m", options.heights.face},
            {"border_m", options.border},
            {"maintenance_factor", options.maintenance_factor},
            {"told_relative_error", json_of(report.told_error)}};
  json["verification"] = report.verification ? verification_json(*report.verification) : Json(nullptr);
  for (const char* list : {"rooms", "luminaires", "luminous_surfaces", "remarks"}) json[list] = Json::array();
  for (const RoomReport& room : report.rooms) json["rooms"].push_back(json_of(room));
  for (const LuminaireType& type : report.luminaires) json["luminaires"].push_back(json_of(type, light));
  for (const EmittingMaterial& material : report.emitting)
    json["luminous_surfaces"].push_back({{"material", material.name}, {"area_m2", material.area}, {light, material.lumens}});
  for (const std::string& remark : report.remarks) json["remarks"].push_back(remark);
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

std::string rooms_csv(const Report& report) {
  std::string text =
      "room,area_m2,points,mean,mean_standard_error,minimum,maximum,uniformity,cylindrical_mean,worst_ugr,electrical_watts,"
      "daylight_factor_median,daylight_factor_on_95_percent\n";
  for (const RoomReport& room : report.rooms) text += room_line(room);
  return text;
}

std::string points_csv(const Report& report) {
  std::string text =
      "room,x,y,z,horizontal,horizontal_standard_error,cylindrical,cylindrical_standard_error,vertical_along_u,vertical_along_v,"
      "vertical_against_u,vertical_against_v,daylight_factor\n";
  for (const RoomReport& room : report.rooms)
    for (std::size_t n = 0; n < room.grid.points.size(); ++n) text += point_line(room, n, report.options.heights.work);
  return text;
}

}  // namespace alvor
