#include "client/command/output/verify_report.h"

#include "client/command/output/numbers.h"
#include "client/command/output/table.h"
#include "client/picture/units.h"

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

namespace alvor {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t worst_shown = 10;

std::string digits(const char* format, double number) {
  char text[48];
  std::snprintf(text, sizeof text, format, number);
  return text;
}

std::string place(Vec3 p) { return digits("%.7g", p.x) + "," + digits("%.7g", p.y) + "," + digits("%.7g", p.z); }

/// Returns 0 for values that would print as zero, so that no "-0" is printed.
double rounded(double cosine) { return std::abs(cosine) < 5e-4 ? 0 : cosine; }

std::string direction(Vec3 n) {
  return digits("%.2g", rounded(n.x)) + "," + digits("%.2g", rounded(n.y)) + "," + digits("%.2g", rounded(n.z));
}

const std::string& material_of(const Scene& scene, const VerifiedPoint& point) {
  return scene.materials[scene.faces[point.at.face].material].name;
}

std::vector<std::string> row_of(const Scene& scene, const VerifiedPoint& point) {
  const double truth = point.truth.mean().mean(), error = point.error();
  return {place(point.at.position),
          direction(point.at.normal),
          std::to_string(point.at.face) + " " + material_of(scene, point),
          digits("%.4g", truth) + " +- " + digits("%.2g", std::sqrt(point.truth.variance_of_band_mean())),
          digits("%.4g", point.solution.mean()),
          truth > 0 ? percent(error / truth) : "-"};
}

std::string worst_table(const Scene& scene, const Verification& verification) {
  const std::string truth = std::string("truth, ") + irradiance_unit(scene.quantity);
  std::vector<std::vector<std::string>> rows{{"worst places", "normal", "face", truth, "solution", "error"}};
  for (const VerifiedPoint& point : worst_points(verification, worst_shown)) rows.push_back(row_of(scene, point));
  return aligned(rows);
}

std::string hidden_note(const Verification& verification) {
  const std::string left_out = "points more, under or inside solids: left out";
  if (verification.hidden_lit == 0) return left_out;
  return left_out + ", though the solution has light at " + std::to_string(verification.hidden_lit);
}

std::string interval(const Confidence& confidence) {
  return "95 %: " + percent(confidence.low) + " to " + percent(confidence.high);
}

/// Returns whether the truth's noise is all that was seen.
bool is_lost_in_noise(const ErrorStatistics& errors) { return errors.nrmse.value == 0 && errors.truth_error > 0; }

Json json_of(const Confidence& confidence) {
  return {{"value", confidence.value}, {"low", confidence.low}, {"high", confidence.high}};
}

Json json_of(const Vec3& v) { return {v.x, v.y, v.z}; }
Json json_of(const Rgb& bands) { return {bands.r, bands.g, bands.b}; }

Json json_of(const Scene& scene, const VerifiedPoint& point) {
  const Rgb variance = point.truth.variance();
  return {{"position", json_of(point.at.position)},
          {"normal", json_of(point.at.normal)},
          {"face", point.at.face},
          {"material", material_of(scene, point)},
          {"truth", json_of(point.truth.mean())},
          {"standard_error", {std::sqrt(variance.r), std::sqrt(variance.g), std::sqrt(variance.b)}},
          {"solution", json_of(point.solution)}};
}

}  // namespace

std::string verify_summary(const Scene& scene, const Verification& verification, const VerifyTimes& times) {
  const ErrorStatistics& errors = verification.errors;
  std::vector<std::vector<std::string>> rows{
      {"nRMSE", percent(errors.nrmse.value),
       interval(errors.nrmse) + (is_lost_in_noise(errors) ? "; less than so many paths can tell" : "")},
      {"bias", percent(errors.bias.value), interval(errors.bias)},
      {"relative RMS", percent(errors.relative_rms), "over points; nRMSE is relative to the mean"},
      {"truth", percent(errors.truth_error), "its standard error, already taken out of the errors above"},
      {"mean", digits("%.4g", errors.mean_truth),
       std::string(irradiance_unit(scene.quantity)) + " of true irradiance, all bands averaged"},
      {"points", std::to_string(errors.points), "of " + std::to_string(verification.paths) + " paths each"},
      {"hidden", std::to_string(verification.hidden), hidden_note(verification)},
      {"dark", std::to_string(verification.dark), "points more, without light in truth and solution: left out"},
      {"time", seconds(times.elapsed_s), seconds(times.cpu_s) + " of CPUs"}};
  if (verification.told)
    rows.insert(rows.begin() + 1,
                {"told", percent(verification.told->nrmse),
                 "by the solution of itself; the truth is within one told error at " + percent(verification.told->within_one) +
                     " of the points, within two at " + percent(verification.told->within_two)});
  return aligned(rows) + "\n" + worst_table(scene, verification);
}

std::string verify_json(const Scene& scene, const Verification& verification, const VerifyTimes& times,
                        std::span<const std::string> warnings) {
  const ErrorStatistics& errors = verification.errors;
  Json json{{"nrmse", json_of(errors.nrmse)},
            {"bias", json_of(errors.bias)},
            {"relative_rms", errors.relative_rms},
            {"truth_error", errors.truth_error},
            {"relative_truth_error", errors.relative_truth_error},
            {"mean_irradiance", errors.mean_truth},
            {"unit", irradiance_unit(scene.quantity)},
            {"points", errors.points},
            {"hidden", verification.hidden},
            {"hidden_lit", verification.hidden_lit},
            {"dark", verification.dark},
            {"paths", verification.paths},
            {"elapsed_s", times.elapsed_s},
            {"cpu_s", times.cpu_s},
            {"worst", Json::array()},
            {"warnings", std::vector<std::string>(warnings.begin(), warnings.end())}};
  if (verification.told)
    json["told"] = {{"nrmse", verification.told->nrmse},
                    {"within_one", verification.told->within_one},
                    {"within_two", verification.told->within_two}};
  for (const VerifiedPoint& point : worst_points(verification, worst_shown)) json["worst"].push_back(json_of(scene, point));
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

}  // namespace alvor
