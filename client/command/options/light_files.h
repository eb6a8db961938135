#pragma once
// The files of lights that the command line adds to a scene.

#include <filesystem>
#include <map>
#include <string>

namespace alvor {

/// Files of one call by the names that its import options use: without folders, and with a number where several have one name.
class LightFiles {
 public:
  /// Reads a file, if it was not added before, and returns its name. `plain` stands in for a name that no scene may have. Throws
  /// Failure (bad_scene) if it cannot be read.
  std::string add(const std::filesystem::path& path, const std::string& plain);
  std::map<std::string, std::string> take() { return std::move(bytes_); }

 private:
  std::map<std::string, std::filesystem::path> paths_;
  std::map<std::string, std::string> bytes_;
};

}  // namespace alvor
