#include "client/command/output/files.h"

#include "client/command/output/failure.h"

#include <unistd.h>

namespace alvor {

bool is_stream(const std::filesystem::path& path) { return path == "-"; }

std::string name_of(const std::filesystem::path& path) { return is_stream(path) ? "stdin" : path.string(); }

void require_writable(const std::filesystem::path& path, const std::string& option) {
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
  const std::string at = option + " " + path.string() + ": ";
  if (!std::filesystem::is_directory(folder)) throw Failure(ExitStatus::usage, at + "there is no folder " + folder.string());
  if (std::filesystem::is_directory(path)) throw Failure(ExitStatus::usage, at + "is a folder");
  if (access(folder.c_str(), W_OK | X_OK) != 0)
    throw Failure(ExitStatus::usage, at + "the folder " + folder.string() + " cannot be written to");
}

void make_folder(const std::filesystem::path& folder, const std::string& example, const std::string& option) {
  if (is_stream(folder)) throw Failure(ExitStatus::usage, option + " -: many files go there, which stdout cannot carry");
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw Failure(ExitStatus::usage, option + " " + folder.string() + ": " + error.message());
  require_writable(folder / example, option);
}

}  // namespace alvor
