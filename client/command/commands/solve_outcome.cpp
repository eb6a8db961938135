#include "client/command/commands/solve_outcome.h"

#include "client/command/output/numbers.h"
#include "client/picture/units.h"
#include "meshing/patch_place.h"
#include "proto/codec.h"

#include <nlohmann/json.hpp>

#include <cstdio>

namespace alvor {

namespace {

std::string line_of(const Step& step) {
  return shortest(step.elapsed_s) + ',' + std::to_string(step.step) + ',' + std::to_string(step.shots) + ',' +
         std::to_string(step.rays) + ',' + std::to_string(step.leaves) + ',' + shortest(step.unshot_fraction) + ',' +
         shortest(step.estimated_error) + '\n';
}

Step last_step(const Followed& followed) {
  const std::vector<Step>& steps = followed.mirror.steps();
  return steps.empty() ? Step{} : steps.back();
}

/// Returns a note about the area that looks black because its light is not known yet.
std::string unlit(const Step& step) {
  if (step.unlit_fraction == 0) return {};
  return percent(step.unlit_fraction) +
         " of the surface that light may reach has no light yet: the solve ended before its turn\n";
}

std::string text_of(std::span<const ObjectError> errors) {
  std::string line;
  for (const ObjectError& of : errors)
    line += (line.empty() ? "where the squared error lies: " : ", ") +
            (of.name.empty() ? "faces of no object" : "'" + of.name + "'") + ' ' + percent(of.error_share) + " on " +
            percent(of.area_share) + " of the area";
  return line.empty() ? line : line + '\n';
}

std::string text_of(const MeanLight& light) {
  char text[120];
  std::snprintf(text, sizeof text, "mean %s of all surfaces %.4g %s (%.4g m2)\n",
                light.quantity == Quantity::photometric ? "illuminance" : "irradiance", light.irradiance,
                irradiance_unit(light.quantity), light.area);
  return text;
}

/// Returns a hint where an error that is small beside the mean light may be large in a room: by day the outside of its walls
/// makes the mean.
std::string dim_area(const MeanLight& light) {
  constexpr double much = 0.2;
  if (light.dim_share < much) return {};
  return percent(light.dim_share) +
         " of the area has less than a tenth of the mean light, to which the error is relative: --area-share 0.95 keeps the "
         "tolerance there, too\n";
}

}  // namespace

std::string step_table(std::span<const Step> steps) {
  std::string table = "elapsed_s,step,shots,rays,leaves,unshot_fraction,estimated_error\n";
  for (const Step& step : steps) table += line_of(step);
  return table;
}

MeanLight mean_light(const BaseMesh& mesh, std::span<const LeafValue> leaves) {
  MeanLight light{.quantity = mesh.quantity()};
  const auto irradiance_of = [&](const LeafValue& leaf) { return one_number(widen(leaf.irradiance), light.quantity); };
  double power = 0, dim = 0;
  for (const LeafValue& leaf : leaves) power += area_of(mesh, shape_of(mesh, leaf.patch)) * irradiance_of(leaf);
  for (const RootPatch& root : mesh.roots()) light.area += root.is_hidden ? 0 : root.area;
  if (!(light.area > 0)) return light;
  light.irradiance = power / light.area;
  constexpr double far_less = 0.1;
  for (const LeafValue& leaf : leaves)
    if (const double here = irradiance_of(leaf); here > 0 && here < far_less * light.irradiance)
      dim += area_of(mesh, shape_of(mesh, leaf.patch));
  light.dim_share = dim / light.area;
  return light;
}

std::string outcome_json(const Followed& followed, const MeanLight& light, std::span<const ObjectError> errors,
                         std::span<const std::string> warnings) {
  const Step last = last_step(followed);
  nlohmann::ordered_json json;
  json["solve"] = followed.solve.name();
  json["state"] = v1::Solve::State_Name(followed.solve.state());
  json["end_reason"] = followed.solve.end_reason();
  json["elapsed_s"] = last.elapsed_s;
  json["cpu_s"] = decode_seconds(followed.solve.cpu_time());
  json["traversal_share"] = followed.solve.traversal_share();
  json["shots"] = last.shots;
  json["rays"] = last.rays;
  json["leaves"] = last.leaves;
  json["unshot_fraction"] = last.unshot_fraction;
  json["estimated_error"] = last.estimated_error;
  json["area_within"] = last.area_within;
  json["largest_errors"] = nlohmann::ordered_json::array();
  for (const ObjectError& of : errors)
    json["largest_errors"].push_back({{"object", of.name}, {"area_share", of.area_share}, {"error_share", of.error_share}});
  json["unlit_fraction"] = last.unlit_fraction;
  json["mean_irradiance"] = light.irradiance;
  json["irradiance_unit"] = irradiance_unit(light.quantity);
  json["first_frame_s"] = followed.first_frame_s;
  json["warnings"] = std::vector<std::string>(warnings.begin(), warnings.end());
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + '\n';
}

std::string summary(const Followed& followed, const MeanLight& light, std::span<const ObjectError> errors) {
  const Step last = last_step(followed);
  const std::string& reason = followed.solve.end_reason();
  const v1::SolveSpec& spec = followed.solve.effective_spec();
  const bool is_reached = is_by_place(spec) ? last.area_within >= spec.area_share() : last.estimated_error <= spec.tolerance();
  const std::string by_place = is_by_place(spec)
                                   ? " (" + percent(spec.tolerance()) + " kept on " + percent(last.area_within) +
                                         (spec.objects_size() > 0 ? " of the area of the named objects)" : " of the area)")
                                   : "";
  return compact(static_cast<double>(last.leaves)) + " leaves, " + compact(static_cast<double>(last.rays)) + " rays, " +
         seconds(last.elapsed_s) + ", estimated error " + percent(last.estimated_error) + by_place + ": " +
         (reason.empty() ? "still running" : reason) + '\n' + unlit(last) + (is_reached ? "" : text_of(errors)) + text_of(light) +
         (is_by_place(spec) ? "" : dim_area(light));
}

}  // namespace alvor
