#pragma once
// The solution at given points, and the CSV files of `alvor probe`.

#include "meshing/display_mesh.h"

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace alvor {

/// A point on a surface (or near it) and the way the surface faces there.
struct ProbePoint {
  Vec3 point;   ///< metres
  Vec3 normal;  ///< need not be unit, but not zero
};

/// Where a point lies.
enum class ProbePlace {
  on_surface,  ///< of a face that looks the same way within 60 degrees, or within 1e-4 of the scene's extent of it
  in_air,      ///< farther off
  enclosed,    ///< inside a solid or outside the room: most of what can be seen from there are backs of surfaces
};

/// Values that do not apply are NaN.
struct ProbeSample {
  Vec3 point, normal;          ///< as asked
  RgbF irradiance, radiosity;  ///< in air no radiosity, enclosed neither
  double distance = 0;         ///< to the nearest surface that faces the same way, metres; infinite if there is none
  double standard_error = 0;   ///< of the mean of the bands of what was gathered in air, W/m2; else NaN
  ProbePlace place = ProbePlace::on_surface;
};

/// Returns one sample per point, in order: on a surface the solution there, interpolated within its triangle; in the air the
/// irradiance of a small surface that looks along the normal (client/verify/gather.h). Uses all cores; the same points give the
/// same samples. `absorption` is of the medium that filled the scene when it was solved, 1/m per band: solution files do not hold
/// it. Requires: !mesh.positions.empty().
std::vector<ProbeSample> probe(const DisplayMesh& mesh, std::span<const ProbePoint> points, const Rgb& absorption = {});

/// Returns for each point, in order, the solution on the nearest surface that faces the same way, however far it is; its distance
/// is infinite and its values are NaN where there is none.
std::vector<ProbeSample> probe_surfaces(const DisplayMesh& mesh, std::span<const ProbePoint> points);

/// Lines `x,y,z,nx,ny,nz`; a header line and blank lines are skipped. Throws FileError (import/whole_file.h) that names the line.
std::vector<ProbePoint> read_points(const std::filesystem::path& path);

/// Reads the text of such a file, which errors call `name`.
std::vector<ProbePoint> parse_points(std::string_view text, const std::string& name);

/// A header and one line per sample: W/m2, metres.
std::string samples_csv(std::span<const ProbeSample> samples);

}  // namespace alvor
