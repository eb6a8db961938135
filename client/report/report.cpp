#include "client/report/report.h"

#include "client/picture/units.h"
#include "client/report/isolux.h"

#include <algorithm>
#include <cmath>
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

/// Returns the observers in a room: those asked for, or four who stand at the middles of the walls and look across.
std::vector<Observer> observers_in(const Room& room, const ReportOptions& options) {
  const PlanFrame& frame = room.frame;
  const double middle_u = room.left + room.length / 2, middle_v = room.bottom + room.width / 2;
  const double height = room.floor_height + options.heights.face;
  std::vector<Observer> all = options.observers;
  if (all.empty())
    all = {{frame.place(room.left, middle_v, height), frame.u},
           {frame.place(room.left + room.length, middle_v, height), -frame.u},
           {frame.place(middle_u, room.bottom, height), frame.v},
           {frame.place(middle_u, room.bottom + room.width, height), -frame.v}};
  std::erase_if(all, [&](const Observer& observer) {
    const double above = dot(observer.eye, frame.up) - room.floor_height;
    return !(above > 0 && above < room.clear_height) ||
           room.cell_at(dot(observer.eye, frame.u), dot(observer.eye, frame.v)) == Room::Cell::elsewhere;
  });
  return all;
}

/// Returns the value that this share of the values reaches. Requires: not empty.
double reached_by(std::vector<double> values, double share) {
  std::ranges::sort(values, std::greater{});
  const auto count = static_cast<double>(values.size());
  return values[std::min(values.size() - 1, static_cast<std::size_t>(std::ceil(share * count)) - 1)];
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
        meter_{measured_.gatherer, mesh.quantity, told_relative_error(mesh).value_or(0)},
        glare_(mesh, measured_.gatherer) {
    if (overcast) overcast_.emplace(overcast->mesh, options.absorption), outside_ = overcast->outside;
  }

  std::vector<RoomReport> rooms() const {
    std::vector<RoomReport> reports;
    for (Room& room : rooms_of(measured_.mesh, options_.border)) reports.push_back(report_of(std::move(room)));
    return reports;
  }

 private:
  RoomReport report_of(Room room) const {
    RoomReport report{std::move(room), {}, {}, {}, {}, {}, {}, {}};
    report.grid = grid_of(report.room);
    report.light = light_on(report.room, report.grid, options_.heights, meter_);
    scale(report.light, options_.maintenance_factor);
    report.horizontal = statistics_of(values_of(report.light, &PointLight::horizontal));
    report.cylindrical = statistics_of(values_of(report.light, &PointLight::cylindrical));
    report.power = power_in(report.room, measured_.mesh);
    if (measured_.mesh.quantity == Quantity::photometric)
      for (const Observer& observer : observers_in(report.room, options_))
        report.glare.push_back({observer, glare_.at(observer, report.glare.size())});
    if (overcast_) report.daylight = daylight_in(report);
    return report;
  }

  WorkGrid grid_of(const Room& room) const {
    try {
      return work_grid(room, options_.spacing);
    } catch (const std::length_error& error) {
      throw ReportError(room.name + ": " + error.what());
    }
  }

  std::optional<DaylightFactors> daylight_in(const RoomReport& report) const {
    const LightMeter meter{overcast_->gatherer, overcast_->mesh.quantity, 0};
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

Image plan_of(const RoomReport& report, const DisplayMesh& mesh) {
  const auto values = report.horizontal_values();
  IsoluxPlan plan{report.room, report.grid, values, {}, irradiance_unit(mesh.quantity), std::nullopt};
  for (const Light& light : mesh.lights)
    if (is_in(report.room, light)) plan.luminaires.push_back(light);
  return draw_isolux(plan);
}

void add_remarks(const DisplayMesh& mesh, Report& report) {
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

std::vector<std::optional<double>> RoomReport::horizontal_values() const {
  std::vector<std::optional<double>> values;
  for (const PointLight& point : light)
    values.push_back(point.horizontal ? std::optional(point.horizontal->value) : std::nullopt);
  return values;
}

Report make_report(const DisplayMesh& mesh, const ReportOptions& options, const std::optional<DaylightSolution>& overcast) {
  Report report;
  report.quantity = mesh.quantity;
  report.options = options;
  report.rooms = Reporter(mesh, options, overcast).rooms();
  if (report.rooms.empty())
    throw ReportError("there is no floor: no horizontal surface of 1 m2 or more that faces up with room to stand on it");
  report.luminaires = luminaire_types(mesh);
  report.emitting = emitting_materials(mesh);
  report.has_distant_light = std::ranges::any_of(mesh.lights, &Light::is_distant);
  report.told_error = told_relative_error(mesh);
  for (const RoomReport& room : report.rooms) report.plans.push_back(plan_of(room, mesh));
  add_remarks(mesh, report);
  return report;
}

}  // namespace alvor
