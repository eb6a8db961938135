#include "client/command/options/light_files.h"

#include "client/command/output/failure.h"
#include "import/base/scene_files.h"
#include "import/base/scene_format.h"
#include "import/base/whole_file.h"

namespace alvor {

std::string LightFiles::add(const std::filesystem::path& path, const std::string& plain) {
  const std::string own = path.filename().string();
  const std::string first = reason_against_name(own).empty() ? own : plain + lower_case_extension(path);
  std::string name = first;
  for (int n = 2; paths_.contains(name) && paths_.at(name) != path; ++n) name = std::to_string(n) + "_" + first;
  if (!paths_.emplace(name, path).second) return name;
  try {
    bytes_.emplace(name, read_whole_file(path));
  } catch (const FileError& error) {
    throw Failure(ExitStatus::bad_scene, error.what());
  }
  return name;
}

}  // namespace alvor
