#include "client/verify/probe.h"

#include "client/verify/gather.h"
#include "import/base/whole_file.h"
#include "meshing/mesh_radiosity.h"
#include "radiosity/rays/triangle_caster.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <initializer_list>
#include <limits>
#include <optional>
#include <string_view>

namespace alvor {
namespace {

constexpr RgbF not_a_value{std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::quiet_NaN(),
                           std::numeric_limits<float>::quiet_NaN()};

RgbF interpolated(const DisplayMesh& mesh, const std::vector<RgbF>& values, const TriangleCaster::Hit& hit) {
  const auto [a, b, c] = mesh.triangles[hit.triangle];
  return narrow((1 - hit.u - hit.v) * widen(values[a]) + hit.u * widen(values[b]) + hit.v * widen(values[c]));
}

double extent_of(const DisplayMesh& mesh) {
  Vec3 low = mesh.positions.front(), high = low;
  for (const Vec3& p : mesh.positions) {
    low = lower(low, p);
    high = upper(high, p);
  }
  return std::max({high.x - low.x, high.y - low.y, high.z - low.z});
}

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

ProbeSample on_nearest_surface(const DisplayMesh& mesh, const TriangleCaster& caster, const MeshRadiosity& radiosity,
                               const ProbePoint& asked) {
  ProbeSample sample{asked.point, asked.normal, not_a_value, not_a_value, std::numeric_limits<double>::infinity(), nan, nan};
  const auto hit = caster.nearest(asked.point, normalized(asked.normal));
  if (!hit) return sample;
  sample.distance = hit->distance;
  sample.irradiance = interpolated(mesh, mesh.irradiance, *hit);
  sample.radiosity = narrow(radiosity.at(hit->triangle, hit->u, hit->v));
  if (!mesh.errors.empty()) sample.error = error_at(mesh, hit->triangle, hit->u, hit->v);
  return sample;
}

/// Replaces a sample's values from the nearest surface by the light gathered at the point itself.
void gather_at(ProbeSample& sample, const Gatherer& gatherer, std::uint64_t stream) {
  sample.irradiance = sample.radiosity = not_a_value;
  sample.error = nan;
  const auto gathered = gatherer.gather(sample.point, normalized(sample.normal), stream);
  sample.place = gathered ? ProbePlace::in_air : ProbePlace::enclosed;
  if (!gathered) return;
  sample.irradiance = narrow(gathered->irradiance);
  sample.standard_error = gathered->standard_error;
}

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blanks = " \t\r";
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

std::vector<std::string_view> fields_of(std::string_view line) {
  std::vector<std::string_view> fields;
  for (std::size_t comma = line.find(','); comma != std::string_view::npos; comma = line.find(',')) {
    fields.push_back(trimmed(line.substr(0, comma)));
    line.remove_prefix(comma + 1);
  }
  fields.push_back(trimmed(line));
  return fields;
}

std::optional<double> number_of(std::string_view field) {
  double value = 0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (error != std::errc{} || end != field.data() + field.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

/// The point on one line, or the reason why it cannot be read.
struct ParsedLine {
  ProbePoint point;
  std::string fault;
};

ParsedLine parse_line(std::string_view line) {
  const auto fields = fields_of(line);
  if (fields.size() != 6) return {{}, "needs x,y,z,nx,ny,nz but has " + std::to_string(fields.size()) + " fields"};
  std::array<double, 6> numbers{};
  for (std::size_t i = 0; i < 6; ++i) {
    const auto number = number_of(fields[i]);
    if (!number) return {{}, "'" + std::string(fields[i].substr(0, 40)) + "' is not a finite number"};
    numbers[i] = *number;
  }
  const Vec3 normal{numbers[3], numbers[4], numbers[5]};
  const double size = length(normal);
  if (!(size > 0) || !std::isfinite(size)) return {{}, "the normal has no direction"};
  return {{{numbers[0], numbers[1], numbers[2]}, normal}, {}};
}

bool is_header(std::string_view line) { return !number_of(fields_of(line).front()); }

void append_numbers(std::string& text, std::initializer_list<double> numbers) {
  for (const double number : numbers) {
    char digits[32];
    text.append(digits, static_cast<std::size_t>(std::snprintf(digits, sizeof digits, "%.9g,", number)));
  }
}

}  // namespace

std::vector<ProbeSample> probe_surfaces(const DisplayMesh& mesh, std::span<const ProbePoint> points) {
  const TriangleCaster caster(mesh.positions, mesh.triangles);
  const MeshRadiosity radiosity(mesh);
  std::vector<ProbeSample> samples;
  samples.reserve(points.size());
  for (const ProbePoint& point : points) samples.push_back(on_nearest_surface(mesh, caster, radiosity, point));
  return samples;
}

std::vector<ProbeSample> probe(const DisplayMesh& mesh, std::span<const ProbePoint> points, const Rgb& absorption) {
  constexpr double on_surface = 1e-4;  // fraction of the extent
  const double reach = on_surface * extent_of(mesh);
  const TriangleCaster caster(mesh.positions, mesh.triangles);
  const MeshRadiosity radiosity(mesh);
  const Gatherer gatherer(mesh, caster, absorption);
  std::vector<ProbeSample> samples(points.size());
  tbb::parallel_for(std::size_t{0}, points.size(), [&](std::size_t n) {
    samples[n] = on_nearest_surface(mesh, caster, radiosity, points[n]);
    if (samples[n].distance > reach) gather_at(samples[n], gatherer, n);
  });
  return samples;
}

std::vector<ProbePoint> read_points(const std::filesystem::path& path) {
  return parse_points(read_whole_file(path), path.string());
}

std::vector<ProbePoint> parse_points(std::string_view text, const std::string& name) {
  std::vector<ProbePoint> points;
  bool header_may_come = true;
  std::size_t number = 0;
  for (std::size_t start = 0; start < text.size(); ++number) {
    const std::size_t end = std::min(text.find('\n', start), text.size());
    const std::string_view line = trimmed(text.substr(start, end - start));
    start = end + 1;
    if (line.empty()) continue;
    const bool skip = header_may_come && is_header(line);
    header_may_come = false;
    if (skip) continue;
    const ParsedLine parsed = parse_line(line);
    if (!parsed.fault.empty()) throw FileError(name + ": line " + std::to_string(number + 1) + ": " + parsed.fault);
    points.push_back(parsed.point);
  }
  return points;
}

std::string samples_csv(std::span<const ProbeSample> samples) {
  std::string text =
      "x,y,z,nx,ny,nz,irradiance_r,irradiance_g,irradiance_b,radiosity_r,radiosity_g,radiosity_b,"
      "distance,standard_error,irradiance_error\n";
  for (const ProbeSample& s : samples) {
    append_numbers(text, {s.point.x, s.point.y, s.point.z, s.normal.x, s.normal.y, s.normal.z});
    append_numbers(text, {s.irradiance.r, s.irradiance.g, s.irradiance.b, s.radiosity.r, s.radiosity.g, s.radiosity.b});
    append_numbers(text, {s.distance, s.standard_error, s.error});
    text.back() = '\n';
  }
  return text;
}

}  // namespace alvor
