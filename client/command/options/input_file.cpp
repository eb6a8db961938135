#include "client/command/options/input_file.h"

#include "client/command/output/failure.h"
#include "client/command/output/files.h"
#include "client/export/solution_file.h"
#include "import/base/scene_files.h"
#include "import/base/whole_file.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <optional>

namespace alvor {

namespace {

constexpr std::size_t most_bytes = 0xffffffff;  // the limit for files (import/base/whole_file.cpp)
constexpr std::size_t piece = 1 << 20;

std::string read_stdin() {
  std::string bytes;
  for (std::size_t filled = 0;;) {
    bytes.resize(filled + piece);
    const ssize_t count = read(STDIN_FILENO, bytes.data() + filled, piece);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw Failure(ExitStatus::bad_scene, std::string("stdin: read: ") + std::strerror(errno));
    filled += static_cast<std::size_t>(count);
    if (filled > most_bytes) throw Failure(ExitStatus::bad_scene, "stdin: read: larger than 4 GB");
    if (count > 0) continue;
    bytes.resize(filled);
    return bytes;
  }
}

std::string lower_case(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

/// Returns the extension of a format: "glb", "GLB" and ".glb" are the same.
std::string extension_of(const std::string& format) { return lower_case(format.starts_with('.') ? format : "." + format); }

std::string formats_of(InputKind kind) {
  return kind == InputKind::solution ? "glb, ply or alvor" : "obj, gltf, glb, ply, stl, 3ds, dae, fbx or another that Assimp reads";
}

bool is_known(InputKind kind, const std::string& extension) {
  return kind == InputKind::solution ? extension == ".glb" || extension == ".ply" || extension == ".alvor" : is_scene_extension(extension);
}

void require_format(InputKind kind, const std::string& format) {
  const std::string what = kind == InputKind::solution ? "a solution" : "a scene";
  if (format.empty())
    throw Failure(ExitStatus::usage, "-: stdin has no suffix that tells the format: add --format " + formats_of(kind));
  if (!is_known(kind, extension_of(format)))
    throw Failure(ExitStatus::usage, "--format " + format + ": " + what + " is read as " + formats_of(kind));
}

DisplayMesh read_any_solution(const std::filesystem::path& path, const std::string& format) {
  try {
    return is_stream(path) ? decode_solution(read_stdin(), extension_of(format), name_of(path)) : read_solution_file(path);
  } catch (const SolutionFileError& error) {
    throw Failure(ExitStatus::bad_scene, error.what());
  }
}

}  // namespace

void add_format_option(CLI::App& command, std::string& format) {
  command.add_option("--format", format, "Format of a scene or solution read from stdin (file -), as a suffix: glb")
      ->type_name("FORMAT");
}

void require_inputs(std::initializer_list<InputFile> inputs, const std::string& format) {
  std::optional<InputKind> from_stdin;
  for (const InputFile& input : inputs) {
    if (!is_stream(input.path)) continue;
    if (from_stdin) throw Failure(ExitStatus::usage, "only one input can be - (stdin)");
    from_stdin = input.kind;
  }
  if (from_stdin && from_stdin != InputKind::points) require_format(*from_stdin, format);
  else if (!format.empty())
    throw Failure(ExitStatus::usage, "--format is for scenes and solutions from - (stdin): the name of a file tells its format");
}

SceneFile read_scene(const std::filesystem::path& path, const std::string& format, const SceneImport& import) {
  if (!is_stream(path)) return read_scene_file(path, import);
  return read_scene_content({name_of(path), read_stdin(), extension_of(format), {}}, import);
}

RawScene scene_bytes(const std::filesystem::path& path, const std::string& format) {
  if (is_stream(path)) return {"scene" + extension_of(format), read_stdin(), {}};
  const std::string name = path.filename().string();
  return {reason_against_name(name).empty() ? name : "scene" + path.extension().string(), read_scene_bytes(path),
          path.parent_path()};
}

DisplayMesh read_solution(const std::filesystem::path& path, const std::string& format) {
  DisplayMesh mesh = read_any_solution(path, format);
  if (mesh.triangles.empty()) throw Failure(ExitStatus::bad_scene, name_of(path) + ": holds no surface");
  return mesh;
}

void require_told_errors(const DisplayMesh& solution, const std::string& name) {
  if (!solution.errors.empty()) return;
  const bool is_dark = std::ranges::all_of(solution.irradiance, &RgbF::is_zero);
  throw Failure(ExitStatus::bad_scene, name + ": tells no errors: " +
                                           (is_dark ? "no surface has any light, or its solve has not found any yet"
                                                    : "it was written by an older version, or its solve was stopped before its "
                                                      "first estimate"));
}

std::vector<ProbePoint> read_asked_points(const std::filesystem::path& path) {
  try {
    return is_stream(path) ? parse_points(read_stdin(), name_of(path)) : read_points(path);
  } catch (const FileError& error) {
    throw Failure(ExitStatus::bad_scene, error.what());
  }
}

}  // namespace alvor
