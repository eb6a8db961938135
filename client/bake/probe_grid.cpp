#include "client/bake/probe_grid.h"

#include "client/verify/probe.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace alvor {

namespace {

using nlohmann::json;

/// A direction and the share of the sphere that it stands for.
struct WeightedDirection {
  Vec3 direction;
  double weight;
};

std::vector<WeightedDirection> directions_of_degree_9() {
  constexpr double golden = std::numbers::phi, of_icosahedron = 25.0 / 840, of_dodecahedron = 27.0 / 840;
  std::vector<WeightedDirection> directions;
  const auto add = [&](double x, double y, double z, double weight) {
    directions.push_back({normalized(Vec3{x, y, z}), weight});
  };
  for (const double a : {-1.0, 1.0})
    for (const double b : {-1.0, 1.0}) {
      add(0, a, b * golden, of_icosahedron), add(a, b * golden, 0, of_icosahedron), add(b * golden, 0, a, of_icosahedron);
      add(0, a / golden, b * golden, of_dodecahedron), add(a / golden, b * golden, 0, of_dodecahedron);
      add(b * golden, 0, a / golden, of_dodecahedron);
      for (const double c : {-1.0, 1.0}) add(a, b, c, of_dodecahedron);
    }
  return directions;
}

std::vector<Vec3> places(const DisplayMesh& solution, const ProbeCounts& counts) {
  Vec3 low = solution.positions.front(), high = low;
  for (const Vec3& p : solution.positions) low = lower(low, p), high = upper(high, p);
  const Vec3 size = high - low;
  std::vector<Vec3> places;
  for (int z = 0; z < counts[2]; ++z)
    for (int y = 0; y < counts[1]; ++y)
      for (int x = 0; x < counts[0]; ++x)
        places.push_back(low + Vec3{size.x * (x + 0.5) / counts[0], size.y * (y + 0.5) / counts[1], size.z * (z + 0.5) / counts[2]});
  return places;
}

}  // namespace

std::array<double, 9> spherical_harmonics(Vec3 n) {
  const double s0 = std::sqrt(1 / (4 * std::numbers::pi)), s1 = std::sqrt(3 / (4 * std::numbers::pi)),
               s2 = std::sqrt(15 / (4 * std::numbers::pi));
  return {s0,
          s1 * n.y,
          s1 * n.z,
          s1 * n.x,
          s2 * n.x * n.y,
          s2 * n.y * n.z,
          s2 / (2 * std::sqrt(3.0)) * (3 * n.z * n.z - 1),
          s2 * n.x * n.z,
          s2 / 2 * (n.x * n.x - n.y * n.y)};
}

Rgb AirProbe::irradiance_along(Vec3 normal) const {
  const auto values = spherical_harmonics(normal);
  Rgb sum;
  for (std::size_t k = 0; k < values.size(); ++k) sum += values[k] * irradiance[k];
  return sum;
}

std::vector<AirProbe> probe_grid(const DisplayMesh& solution, const ProbeCounts& counts, const Rgb& absorption) {
  const auto directions = directions_of_degree_9();
  std::vector<ProbePoint> points;
  std::vector<AirProbe> probes;
  for (const Vec3& at : places(solution, counts)) {
    probes.push_back({at, {}, false});
    for (const WeightedDirection& towards : directions) points.push_back({at, towards.direction});
  }
  const std::vector<ProbeSample> samples = probe(solution, points, absorption);
  for (std::size_t p = 0; p < probes.size(); ++p) {
    AirProbe& of = probes[p];
    // One that stands on a surface within rounding has no air about it either.
    for (std::size_t d = 0; d < directions.size(); ++d)
      of.is_enclosed = of.is_enclosed || samples[p * directions.size() + d].place != ProbePlace::in_air;
    for (std::size_t d = 0; d < directions.size() && !of.is_enclosed; ++d) {
      const auto values = spherical_harmonics(directions[d].direction);
      const Rgb part = 4 * std::numbers::pi * directions[d].weight * widen(samples[p * directions.size() + d].irradiance);
      for (std::size_t k = 0; k < values.size(); ++k) of.irradiance[k] += values[k] * part;
    }
  }
  return probes;
}

std::vector<AirProbe> turned_upright(std::vector<AirProbe> probes, UpAxis up) {
  if (up == UpAxis::y) return probes;
  for (AirProbe& probe : probes) {
    probe.at = {probe.at.x, probe.at.z, -probe.at.y};
    // With (x, y, z) = (X, -Z, Y) of the turned axes, harmonics become sums of others: yz and xy change places with a sign, and so on.
    const auto of = probe.irradiance;
    const double root3 = std::sqrt(3.0);
    // x2 - y2 = X2 - Z2 and 3 z2 - 1 = 3 Y2 - 1, written in 3 Z2 - 1 and X2 - Y2.
    probe.irradiance = {of[0],        of[2],         -1.0 * of[1], of[3],
                        of[7],        -1.0 * of[5],  -0.5 * of[6] - root3 / 2 * of[8],
                        -1.0 * of[4], 0.5 * of[8] - root3 / 2 * of[6]};
  }
  return probes;
}

json probes_json(const std::vector<AirProbe>& probes, const ProbeCounts& counts, Quantity quantity) {
  json list = json::array();
  for (const AirProbe& probe : probes) {
    json coefficients = json::array();
    for (const Rgb& c : probe.irradiance) coefficients.push_back({c.r, c.g, c.b});
    list.push_back({{"at", {probe.at.x, probe.at.y, probe.at.z}},
                    {"irradiance", probe.is_enclosed ? json() : std::move(coefficients)}});
  }
  return json{{"counts", counts},
              {"quantity", "irradiance by direction, real orthonormal spherical harmonics up to l = 2"},
              {"unit", quantity == Quantity::photometric ? "lx" : "W/m2"},
              {"probes", std::move(list)}};
}

}  // namespace alvor
