#pragma once
// Light in the air of a room, for things that move in it.

#include "meshing/display_mesh.h"

#include <nlohmann/json.hpp>

#include <array>
#include <vector>

namespace alvor {

/// The irradiance of a small surface at one place, by the direction that it faces.
struct AirProbe {
  Vec3 at;  ///< metres, in the axes of the scene
  /// Coefficients of the real orthonormal spherical harmonics up to l = 2 of irradiance by direction, W/m2 or lx, in the order (l, m) =
  /// (0, 0), (1, -1), (1, 0), (1, 1), (2, -2) to (2, 2). Zero if enclosed.
  std::array<Rgb, 9> irradiance;
  bool is_enclosed = false;  ///< inside a solid or outside the room

  /// Returns the irradiance of a surface that faces along `normal` (unit).
  Rgb irradiance_along(Vec3 normal) const;
};

/// How many probes stand in a row along each axis.
using ProbeCounts = std::array<int, 3>;
inline constexpr int most_probes = 100'000;

/// Returns the values of these functions in a direction (unit), in the order of AirProbe::irradiance.
std::array<double, 9> spherical_harmonics(Vec3 direction);

/// Gathers light in the middles of the cells of a grid over the solution's bounding box, x fastest, then y, then z. Each probe asks for
/// the irradiance along 32 directions, the corners of an icosahedron and a dodecahedron, and projects it by the rule of degree 9 that
/// they make (McLaren 1963). Irradiance is smooth in direction: beyond l = 2 are at most a few hundredths of it (Ramamoorthi &
/// Hanrahan 2001). Uses all cores. Requires: counts are positive and their product is at most most_probes.
std::vector<AirProbe> probe_grid(const DisplayMesh& solution, const ProbeCounts& counts, const Rgb& absorption = {});

/// Returns probes of a scene as a glTF file has them, whose y axis is up: places and directions of a z-up scene are turned.
std::vector<AirProbe> turned_upright(std::vector<AirProbe> probes, UpAxis up);

/// Returns a JSON object: {"counts", "quantity", "unit", "probes": [{"at", "irradiance": nine of [r, g, b]}]}, with null for probes that are
/// enclosed.
nlohmann::json probes_json(const std::vector<AirProbe>& probes, const ProbeCounts& counts, Quantity quantity);

}  // namespace alvor
