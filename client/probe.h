#pragma once
// The solution at given points, and the CSV files of `alvor probe`.

#include "meshing/display_mesh.h"

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace alvor {

/// A point on a surface (or near it) and the way the surface faces there.
struct ProbePoint {
  Vec3 point;   ///< metres
  Vec3 normal;  ///< need not be unit, but not zero
};

struct ProbeSample {
  Vec3 point, normal;  ///< as asked
  RgbF irradiance, radiosity;
  bool found = false;  ///< false: no surface faces this way, and the values are NaN
};

/// The nearest surface that faces the same way, interpolated within its triangle. One sample per point, in order.
std::vector<ProbeSample> probe(const DisplayMesh& mesh, std::span<const ProbePoint> points);

/// Lines `x,y,z,nx,ny,nz`; a header line and blank lines are skipped. Throws FileError (client/whole_file.h) that names the line.
std::vector<ProbePoint> read_points(const std::filesystem::path& path);

/// A header and one line per sample, W/m2.
std::string samples_csv(std::span<const ProbeSample> samples);

}  // namespace alvor
