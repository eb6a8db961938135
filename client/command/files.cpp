#include "client/command/files.h"

#include "client/command/failure.h"
#include "client/solution_file.h"

#include <unistd.h>

namespace alvor {

namespace {

DisplayMesh read_any_solution(const std::filesystem::path& path) {
  try {
    return read_solution_file(path);
  } catch (const SolutionFileError& error) {
    throw Failure(ExitStatus::bad_scene, error.what());
  }
}

}  // namespace

void require_writable(const std::filesystem::path& path, const std::string& option) {
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
  const std::string at = option + " " + path.string() + ": ";
  if (!std::filesystem::is_directory(folder)) throw Failure(ExitStatus::usage, at + "there is no folder " + folder.string());
  if (std::filesystem::is_directory(path)) throw Failure(ExitStatus::usage, at + "is a folder");
  if (access(folder.c_str(), W_OK | X_OK) != 0)
    throw Failure(ExitStatus::usage, at + "the folder " + folder.string() + " cannot be written to");
}

DisplayMesh read_solution(const std::filesystem::path& path) {
  DisplayMesh mesh = read_any_solution(path);
  if (mesh.triangles.empty()) throw Failure(ExitStatus::bad_scene, path.string() + ": holds no surface");
  return mesh;
}

}  // namespace alvor
