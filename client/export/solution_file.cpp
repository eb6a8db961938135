#include "client/export/solution_file.h"

#include "client/export/compact_file.h"
#include "client/export/glb_file.h"
#include "client/export/ply_file.h"
#include "client/export/vtu_file.h"
#include "import/base/glb_format.h"
#include "import/base/scene_format.h"
#include "import/base/whole_file.h"

#include <cmath>
#include <cstdint>
#include <limits>

namespace alvor {
namespace {

struct Format {
  std::string (*encode)(const DisplayMesh&);
  DisplayMesh (*decode)(std::string_view);
};

Format format_of(const std::string& extension, const std::string& name) {
  if (extension == ".glb") return {encode_glb, decode_glb};
  if (extension == ".ply") return {encode_ply, decode_ply};
  if (extension == ".alvor") return {nullptr, decode_compact};
  if (extension == ".vtu") return {encode_vtu, nullptr};
  throw SolutionFileError(name + ": name: a solution file ends in .glb, .ply or .alvor");
}

/// Returns what reads files of this extension. Throws SolutionFileError if nothing does.
auto decoder_of(const std::string& extension, const std::string& name) {
  const Format format = format_of(extension, name);
  if (!format.decode) throw SolutionFileError(name + ": name: " + extension + " files are written, but not read");
  return format.decode;
}

constexpr double largest_coordinate = 1e10;  // metres; scenes end at 1e9

bool is_place(const Vec3& p) {
  return std::abs(p.x) < largest_coordinate && std::abs(p.y) < largest_coordinate && std::abs(p.z) < largest_coordinate;
}

/// Throws SolutionFileError unless the vertices are consistent, finite and within bounds, as drawing and probing require.
void check_vertices(const DisplayMesh& mesh) {
  const std::size_t count = mesh.positions.size();
  const bool has_all_points = mesh.texture_points.empty() || mesh.texture_points.size() == count;
  const bool has_all_errors = mesh.errors.empty() || mesh.errors.size() == count;
  const bool has_all_transmitted = mesh.transmitted.empty() || mesh.transmitted.size() == count;
  if (mesh.normals.size() != count || mesh.irradiance.size() != count || mesh.radiosity.size() != count || !has_all_points ||
      !has_all_transmitted || !has_all_errors)
    throw SolutionFileError("vertices: positions, normals and values are not equally many");
  for (std::size_t i = 0; i < count; ++i) {
    const bool values = mesh.irradiance[i].is_finite() && mesh.radiosity[i].is_finite();
    if (!values || !is_place(mesh.positions[i]) || !is_place(mesh.normals[i]))
      throw SolutionFileError("vertex " + std::to_string(i) + ": not finite, or beyond 1e10 m");
  }
  for (std::size_t i = 0; i < mesh.errors.size(); ++i)
    if (!(std::isfinite(mesh.errors[i]) && mesh.errors[i] >= 0))
      throw SolutionFileError("vertex " + std::to_string(i) + ": its error is negative or not finite");
  for (std::size_t i = 0; i < mesh.transmitted.size(); ++i)
    if (!(mesh.transmitted[i].is_finite() && mesh.transmitted[i].min() >= 0))
      throw SolutionFileError("vertex " + std::to_string(i) + ": the light that comes through it is negative or not finite");
  for (std::size_t i = 0; i < mesh.texture_points.size(); ++i)
    for (const float x : {mesh.texture_points[i].s, mesh.texture_points[i].t})
      if (!(std::abs(x) <= most_repeats))
        throw SolutionFileError("vertex " + std::to_string(i) + ": its texture point is beyond 1e5");
}

void check_triangles(const DisplayMesh& mesh) {
  if (mesh.triangles.empty()) throw SolutionFileError("triangles: there are none");
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    for (const std::uint32_t vertex : mesh.triangles[i])
      if (vertex >= mesh.positions.size())
        throw SolutionFileError("triangle " + std::to_string(i) + ": there is no vertex " + std::to_string(vertex));
}

/// Throws SolutionFileError unless the runs of triangles on faces add up to all triangles, and name materials that there are.
void check_faces(const DisplayMesh& mesh) {
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
    sum += mesh.faces[i].count;
    if (!mesh.materials.empty() && mesh.faces[i].material >= mesh.materials.size())
      throw SolutionFileError("face " + std::to_string(i) + ": there is no material " + std::to_string(mesh.faces[i].material));
  }
  if (!mesh.faces.empty() && sum != mesh.triangles.size())
    throw SolutionFileError("faces: have " + std::to_string(sum) + " triangles, but there are " +
                            std::to_string(mesh.triangles.size()));
}

DisplayMesh checked(DisplayMesh mesh) {
  check_vertices(mesh);
  check_triangles(mesh);
  check_faces(mesh);
  check_objects(mesh.objects);
  return mesh;
}

/// Returns the result of `work`. Its errors become SolutionFileError that begin with `name`.
template <class Work>
auto naming(const std::string& name, Work work) {
  try {
    return work();
  } catch (const SolutionFileError& error) {
    throw SolutionFileError(name + ": " + error.what());
  } catch (const FileError& error) {
    throw SolutionFileError(error.what());
  }
}

}  // namespace

void check_objects(std::span<const SceneObject> objects) {
  for (std::size_t i = 0; i < objects.size(); ++i)
    if (const auto reason = fault_in(objects, i, std::numeric_limits<std::uint32_t>::max()))
      throw SolutionFileError("object " + std::to_string(i) + ": " + *reason);
}

void write_solution_file(const std::filesystem::path& path, const DisplayMesh& mesh) {
  naming(path.string(), [&] { write_whole_file(path, encode_solution(mesh, lower_case_extension(path))); });
}

bool is_solution(std::string_view bytes, const std::string& extension) {
  constexpr std::size_t longest_ply_header = 1 << 26;
  if (extension == ".glb") return bytes.substr(0, glb::largest_json).find("\"_IRRADIANCE\":") != bytes.npos;
  const std::string_view text = bytes.substr(0, longest_ply_header);
  if (extension == ".alvor") return true;
  return extension == ".ply" && text.substr(0, text.find("end_header")).find("property float irradiance_r") != text.npos;
}

std::string encode_solution(const DisplayMesh& mesh, const std::string& extension) {
  const Format format = format_of(extension, extension);
  if (!format.encode) throw SolutionFileError(extension + ": is written from leaves, not from triangles");
  return format.encode(mesh);
}

DisplayMesh read_solution_file(const std::filesystem::path& path) {
  const std::string extension = lower_case_extension(path);
  (void)decoder_of(extension, path.string());
  return decode_solution(naming(path.string(), [&] { return read_whole_file(path); }), extension, path.string());
}

DisplayMesh decode_solution(std::string_view bytes, const std::string& extension, const std::string& name) {
  const auto decode = decoder_of(extension, name);
  return naming(name, [&] { return checked(decode(bytes)); });
}

}  // namespace alvor
