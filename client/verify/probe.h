#pragma once
// Reads a solution at given points; reads and writes the CSV files of `alvor probe`.

#include "meshing/display_mesh.h"

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace alvor {

/// A point on or near a surface, and the direction in which the surface faces there.
struct ProbePoint {
  Vec3 point;   ///< metres
  Vec3 normal;  ///< any length but zero
};

/// The position of a point relative to the surfaces.
enum class ProbePlace {
  on_surface,  ///< within 1e-4 of the scene's extent of a face that faces the same way within 60 degrees
  in_air,      ///< farther from such a face
  enclosed,    ///< inside a solid or outside the room: most surfaces around show their backs
};

/// The solution at one point. Values that do not apply are NaN.
struct ProbeSample {
  Vec3 point, normal;          ///< as given
  RgbF irradiance, radiosity;  ///< no radiosity in air; neither if enclosed
  double distance = 0;         ///< to the nearest surface that faces the same way, metres; infinite if there is none
  double standard_error = 0;   ///< standard error of the bands' mean gathered in air, W/m2; else NaN
  double error = 0;            ///< told error of the irradiance on a surface (DisplayMesh::errors), W/m2; NaN if none is told
  ProbePlace place = ProbePlace::on_surface;
};

/// Returns one sample per point, in order: on a surface the solution, interpolated within its triangle; in the air the irradiance
/// of a small surface that faces along the normal (client/verify/gather.h). Uses all cores; the same points give the same
/// samples. `absorption` is the absorption coefficient of the medium in which the scene was solved, 1/m per band: solution files
/// do not store it. Requires: !mesh.positions.empty().
std::vector<ProbeSample> probe(const DisplayMesh& mesh, std::span<const ProbePoint> points, const Rgb& absorption = {});

/// Returns for each point, in order, the solution on the nearest surface that faces the same way, at any distance. If there is
/// none, the distance is infinite and the values are NaN.
std::vector<ProbeSample> probe_surfaces(const DisplayMesh& mesh, std::span<const ProbePoint> points);

/// Reads lines `x,y,z,nx,ny,nz`; a header line and blank lines are skipped. Throws FileError (import/base/whole_file.h) that
/// names the line.
std::vector<ProbePoint> read_points(const std::filesystem::path& path);

/// Reads points from the text of such a file, which errors call `name`.
std::vector<ProbePoint> parse_points(std::string_view text, const std::string& name);

/// Returns a CSV text with a header and one line per sample: W/m2, metres.
std::string samples_csv(std::span<const ProbeSample> samples);

}  // namespace alvor
