#include "import/scene_file.h"

#include "import/assimp_import.h"
#include "import/child_import.h"
#include "import/gltf_import.h"
#include "import/import_error.h"
#include "import/obj_import.h"
#include "import/scene_format.h"

#include <algorithm>
#include <cstdio>
#include <sstream>
#include <string_view>

namespace alvor {

namespace {

/// A face is a line or a point if twice its area over the square of its outline's length is below this.
constexpr double flat = 1e-14;
constexpr std::size_t max_line = 400;

void refuse_unreadable(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) throw ImportError("file", "does not exist");
  if (std::filesystem::is_directory(path, error)) throw ImportError("file", "is a directory");
  const auto size = std::filesystem::file_size(path, error);
  if (!error && size == 0) throw ImportError("file", "is empty");
}

SceneFile import_by_extension(const std::filesystem::path& path) {
  const std::string extension = lower_case_extension(path);
  if (extension == ".obj") return import_obj(path);
  if (extension == ".gltf" || extension == ".glb") return import_gltf(path);
  return import_in_child(path, import_by_assimp);
}

SceneFile import_content(const EncodedScene& content) {
  if (content.bytes.empty()) throw ImportError("file", "is empty");
  const std::string& extension = content.extension;
  if (extension == ".gltf" || extension == ".glb") return import_gltf(content.bytes, content.folder);
  if (extension != ".obj") return import_in_child([&] { return import_by_assimp(content.bytes, extension, content.folder); });
  std::istringstream stream(content.bytes);
  return import_obj(stream, content.folder);
}

/// Returns a band of reflectance clamped to [0, 1). NaN stays as it is and is a fault.
double clamped(double reflectance) {
  if (reflectance < 0) return 0;
  return reflectance >= 1 ? clamped_reflectance : reflectance;
}

std::string text_of(const Rgb& bands) {
  char text[96];
  std::snprintf(text, sizeof text, "%g %g %g", bands.r, bands.g, bands.b);
  return text;
}

void clamp_reflectance(SceneFile& file) {
  for (Material& material : file.scene.materials) {
    const Rgb given = material.reflectance;
    if (!given.is_finite()) continue;
    material.reflectance = {clamped(given.r), clamped(given.g), clamped(given.b)};
    if (material.reflectance == given) continue;
    file.warnings.push_back("material '" + material.name + "': reflectance " + text_of(given) + " is clamped to " +
                            text_of(material.reflectance));
  }
}

bool has_area(const Scene& scene, const Face& face) {
  const auto corners = scene.corners_of(face);
  const Vec3 start = scene.vertices[corners[0]];
  Vec3 double_area;
  double outline = 0;
  for (std::size_t c = 1; c < corners.size(); ++c) {
    const Vec3 from = scene.vertices[corners[c - 1]] - start, to = scene.vertices[corners[c]] - start;
    double_area += cross(from, to);
    outline += length(to - from);
  }
  return length(double_area) > flat * outline * outline;
}

void refuse_faulty(const Scene& scene) {
  if (const auto fault = find_fault(scene)) throw ImportError(fault->place, fault->reason);
  if (std::ranges::none_of(scene.faces, [&](const Face& face) { return has_area(scene, face); }))
    throw ImportError("scene", "all " + std::to_string(scene.faces.size()) + " faces are degenerate");
}

/// Returns `text` on one line of limited length: libraries report in several lines, and quote the file, which may hold anything.
std::string one_line(std::string_view text) {
  std::string line;
  for (const char c : text) {
    const bool blank = static_cast<unsigned char>(c) <= ' ' || c == '\x7f';
    if (!blank) line += c;
    else if (!line.empty() && line.back() != ' ') line += ' ';
  }
  if (line.size() > max_line) line.resize(max_line);
  while (line.ends_with(' ') || line.ends_with('.')) line.pop_back();
  return line;
}

SceneFile import_file(const std::filesystem::path& path) {
  refuse_unreadable(path);
  return import_by_extension(path);
}

SceneFile checked(SceneFile file) {
  clamp_reflectance(file);
  refuse_faulty(file.scene);
  for (std::string& warning : file.warnings) warning = one_line(warning);
  return file;
}

/// Returns the checked result of `import`. Its errors become SceneFileError that begin with `name`.
template <class Import>
SceneFile naming(const std::string& name, Import import) {
  try {
    return checked(import());
  } catch (const ImportError& error) {
    throw SceneFileError(name + ": " + one_line(error.what()));
  } catch (const std::exception& error) {  // thrown by the libraries
    throw SceneFileError(name + ": file: " + one_line(error.what()));
  }
}

}  // namespace

SceneFile read_scene_file(const std::filesystem::path& path) {
  return naming(path.string(), [&] { return import_file(path); });
}

SceneFile read_scene_content(const EncodedScene& content) {
  return naming(content.name, [&] { return import_content(content); });
}

bool is_scene_extension(const std::string& extension) {
  return extension == ".obj" || extension == ".gltf" || extension == ".glb" || is_read_by_assimp(extension);
}

}  // namespace alvor
