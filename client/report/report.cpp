#include "client/report/report.h"

#include "client/picture/units.h"
#include "client/report/isolux.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numeric>

namespace alvor {

namespace {

/// Returns the values of one measure at the points where there is one.
std::vector<Measured> values_of(std::span<const PointLight> lights, std::optional<Measured> PointLight::*measure) {
  std::vector<Measured> values;
  for (const PointLight& light : lights)
    if (light.*measure) values.push_back(*(light.*measure));
  return values;
}

void scale(std::vector<PointLight>& lights, double factor) {
  const auto scale_one = [&](std::optional<Measured>& measured) {
    if (measured) *measured = {measured->value * factor, measured->error * factor};
  };
  for (PointLight& light : lights) {
    scale_one(light.horizontal);
    scale_one(light.cylindrical);
    for (auto& vertical : light.vertical)
      if (vertical) *vertical *= factor;
  }
}

/// Returns four observers at the middles of the sides of a room's inner rectangle, who look across it.
std::array<Observer, 4> usual_observers(const Room& room, double eye_height) {
  constexpr double inwards = 0.01;  // metres: not on the edge itself
  const PlanFrame& frame = room.frame;
  const double left = room.left + inwards, right = room.left + room.length - inwards, bottom = room.bottom + inwards,
               top = room.bottom + room.width - inwards, middle_u = (left + right) / 2, middle_v = (bottom + top) / 2;
  const auto eye = [&](double u, double v) { return frame.place(u, v, room.floor_at(u, v) + eye_height); };
  return {{{eye(left, middle_v), frame.u},
           {eye(right, middle_v), -frame.u},
           {eye(middle_u, bottom), frame.v},
           {eye(middle_u, top), -frame.v}}};
}

/// Returns the observers in each room: those asked for, or the usual ones. Counts in `outside` those who are in no room.
std::vector<std::vector<Observer>> observers_in(std::span<const Room> rooms, const ReportOptions& options, std::size_t& outside) {
  std::vector<Observer> all = options.observers;
  if (all.empty())
    for (const Room& room : rooms)
      for (const Observer& observer : usual_observers(room, options.heights.face)) all.push_back(observer);
  std::vector<std::vector<Observer>> by_room(rooms.size());
  for (const Observer& observer : all) {
    const auto room = room_at(rooms, observer.eye);
    if (room) by_room[*room].push_back(observer);
    else ++outside;
  }
  return by_room;
}

/// Returns the value that this share of the values reaches. Requires: not empty.
double reached_by(std::vector<double> values, double share) {
  std::ranges::sort(values, std::greater{});
  const auto count = static_cast<double>(values.size());
  return values[std::min(values.size() - 1, static_cast<std::size_t>(std::ceil(share * count)) - 1)];
}

WorkGrid grid_of(const Room& room, const ReportOptions& options) {
  try {
    return work_grid(room, options.spacing);
  } catch (const std::length_error& error) {
    throw ReportError(room.name + ": " + error.what());
  }
}

/// A mesh and what is needed to measure light in it.
struct MeasuredMesh {
  explicit MeasuredMesh(const DisplayMesh& solution, const Rgb& absorption)
      : mesh(solution), caster(solution.positions, solution.triangles), gatherer(solution, caster, absorption) {}
  const DisplayMesh& mesh;
  TriangleCaster caster;
  Gatherer gatherer;
};

/// Makes the report of each room.
class Reporter {
 public:
  Reporter(const DisplayMesh& mesh, const ReportOptions& options, const std::optional<DaylightSolution>& overcast)
      : measured_(mesh, options.absorption),
        options_(options),
        meter_{measured_.gatherer, mesh.quantity},
        glare_(mesh, measured_.gatherer) {
    if (overcast) overcast_.emplace(overcast->mesh, options.absorption), outside_ = overcast->outside;
  }

  RoomReport report_of(const Room& room, std::span<const Light* const> lights, std::span<const Observer> observers) const {
    RoomReport report{room, {}, {}, {}, {}, power_of(lights), {}, {}};
    report.grid = grid_of(room, options_);
    report.light = light_on(report.room, report.grid, options_.heights, meter_);
    scale(report.light, options_.maintenance_factor);
    report.horizontal = statistics_of(values_of(report.light, &PointLight::horizontal));
    report.cylindrical = statistics_of(values_of(report.light, &PointLight::cylindrical));
    if (measured_.mesh.quantity == Quantity::photometric)
      for (const Observer& observer : observers) report.glare.push_back({observer, glare_.at(observer, report.glare.size())});
    if (overcast_) report.daylight = daylight_in(report);
    return report;
  }

 private:
  std::optional<DaylightFactors> daylight_in(const RoomReport& report) const {
    const LightMeter meter{overcast_->gatherer, overcast_->mesh.quantity};
    DaylightFactors factors;
    std::vector<double> there;
    for (const auto& light : horizontal_light_on(report.room, report.grid, options_.heights.work, meter)) {
      factors.at_points.emplace_back();
      if (!light) continue;
      factors.at_points.back() = light->value / outside_;
      there.push_back(*factors.at_points.back());
    }
    if (there.empty()) return std::nullopt;
    factors.mean = std::accumulate(there.begin(), there.end(), 0.0) / static_cast<double>(there.size());
    factors.minimum = std::ranges::min(there);
    factors.median = reached_by(there, 0.5);
    factors.on_95_percent = reached_by(there, 0.95);
    return factors;
  }

  MeasuredMesh measured_;
  const ReportOptions& options_;
  LightMeter meter_;
  GlareMeter glare_;
  std::optional<MeasuredMesh> overcast_;
  double outside_ = 0;
};

/// Returns the picture of a plan, as PNG.
std::string plan_of(const RoomReport& report, std::span<const Light* const> lights, Quantity quantity) {
  const auto values = report.horizontal_values();
  return encode_png(draw_isolux({report.room, report.grid, values, lights, irradiance_unit(quantity), std::nullopt}), "plan");
}

/// Adds remarks about lights that hang where they light no room.
void add_remarks_on_places(const DisplayMesh& mesh, std::span<const Room> rooms, Report& report) {
  for (const Light& light : mesh.lights) {
    if (light.is_distant()) continue;
    char place[96];
    std::snprintf(place, sizeof place, "%.4g, %.4g, %.4g", light.position.x, light.position.y, light.position.z);
    const std::string subject = "Light '" + light.name + "' at " + place + " hangs ";
    const auto room = room_at(rooms, light.position);
    if (!room) {
      report.remarks.push_back(subject + "in no room: its power is not counted.");
      continue;
    }
    const PlanFrame& frame = rooms[*room].frame;
    const double floor = rooms[*room].floor_at(dot(light.position, frame.u), dot(light.position, frame.v));
    if (dot(light.position, frame.up) - floor > rooms[*room].clear_height)
      report.remarks.push_back(subject + "above the ceiling of " + rooms[*room].name +
                               ": its light comes in only if there is an opening below it.");
  }
}

void add_remarks(const DisplayMesh& mesh, Report& report) {
  const auto is_dark = [](const RoomReport& room) { return room.horizontal && !(room.horizontal->mean.value > 0); };
  if (std::ranges::any_of(report.rooms, is_dark))
    report.remarks.emplace_back("No light arrives at the work plane of some rooms.");
  for (const RoomReport& room : report.rooms)
    if (!room.horizontal) report.remarks.push_back(room.room.name + ": no grid point is in the open, below the ceiling.");
  if (mesh.quantity == Quantity::radiometric)
    report.remarks.emplace_back("The scene counts light in watts (radiometric): no illuminance in lx, no glare rating.");
  if (!report.told_error) report.remarks.emplace_back("The solution tells no errors of its own.");
  const bool has_points = std::ranges::any_of(mesh.lights, [](const Light& light) {
    return !light.is_distant() && !(light.radius > 0) &&
           (light.kind != LightKind::luminaire || light.opening.shape == LuminousOpening::Shape::point);
  });
  if (has_points && mesh.quantity == Quantity::photometric)
    report.remarks.emplace_back("Lights without a luminous area have no luminance: they are not part of the glare ratings.");
  for (const RoomReport& room : report.rooms)
    if (!room.power.is_complete) report.remarks.push_back(room.room.name + ": the electrical power of some lights is not known.");
}

}  // namespace

std::vector<Room> find_rooms(const DisplayMesh& mesh, const ReportOptions& options) {
  std::vector<Room> rooms;
  try {
    rooms = rooms_of(mesh, options.border);
  } catch (const std::length_error& error) {
    throw ReportError(error.what());
  }
  if (rooms.empty())
    throw ReportError("there is no floor: no horizontal surface of 1 m2 or more that faces up with room to stand on it");
  for (const Room& room : rooms) (void)grid_of(room, options);
  return rooms;
}

std::vector<std::optional<double>> RoomReport::horizontal_values() const {
  std::vector<std::optional<double>> values;
  for (const PointLight& point : light)
    values.push_back(point.horizontal ? std::optional(point.horizontal->value) : std::nullopt);
  return values;
}

Report make_report(const DisplayMesh& mesh, std::span<const Room> rooms, const ReportOptions& options,
                   const std::optional<DaylightSolution>& overcast) {
  Report report;
  report.quantity = mesh.quantity;
  report.options = options;
  std::size_t outside = 0;
  const auto observers = observers_in(rooms, options, outside);
  const auto lights = lights_in(rooms, mesh);
  const Reporter reporter(mesh, options, overcast);
  for (std::size_t n = 0; n < rooms.size(); ++n) {
    report.rooms.push_back(reporter.report_of(rooms[n], lights[n], observers[n]));
    report.plans.push_back(plan_of(report.rooms[n], lights[n], mesh.quantity));
  }
  if (outside > 0 && !options.observers.empty())
    report.remarks.push_back(std::to_string(outside) + " of the observers asked for are in no room.");
  report.luminaires = luminaire_types(mesh);
  report.emitting = emitting_materials(mesh);
  report.has_distant_light = std::ranges::any_of(mesh.lights, &Light::is_distant);
  report.told_error = told_relative_error(mesh);
  report.surfaces = surface_materials(mesh);
  add_remarks_on_places(mesh, rooms, report);
  add_remarks(mesh, report);
  return report;
}

}  // namespace alvor
