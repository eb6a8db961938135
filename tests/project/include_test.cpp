#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>

namespace {

namespace fs = std::filesystem;

// Who may include whom, and the few files that may do more; ARCHITECTURE.md says why.
const std::map<std::string, std::set<std::string>> allowed{
    {"solution", {}},
    {"meshing", {"solution"}},
    {"radiosity", {"meshing", "solution"}},
    {"proto", {"solution", "meshing"}},
    {"server", {"radiosity", "meshing", "solution", "proto"}},
    {"client", {"solution", "meshing", "proto"}},
};
const std::set<std::pair<std::string, std::string>> exceptions{
    {"client/in_process.cpp", "server"},
    {"client/gather.cpp", "radiosity"},
    {"client/gather.h", "radiosity"},
    {"client/probe.cpp", "radiosity"},
    {"client/stage.h", "radiosity"},
    {"client/camera.cpp", "radiosity"},
    {"client/verify/path_tracer.cpp", "radiosity"},
    {"client/command/compare_command.cpp", "radiosity"},
    {"client/command/explain_command.cpp", "radiosity"},
    {"client/command/form_factor_command.cpp", "radiosity"},
    {"client/command/form_factors_command.cpp", "radiosity"},
};
// Libraries that stay behind one folder or file.
const std::map<std::string, std::string> kept_behind{
    {"embree", "radiosity/visibility.cpp"}, {"OpenMesh/", "meshing/base_mesh.cpp"}, {"spdlog/", "server/"}};

struct Include {
  std::string file, target;
};

std::vector<Include> all_includes() {
  std::vector<Include> found;
  const std::regex line_form(R"(^\s*#\s*include\s*["<]([^">]+)[">])");
  for (const auto& [folder, may] : allowed)
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(ALVOR_SOURCE) / folder)) {
      const auto extension = entry.path().extension();
      if (entry.path().string().find("node_modules") != std::string::npos || (extension != ".h" && extension != ".cpp")) continue;
      std::ifstream in(entry.path());
      std::smatch match;
      for (std::string line; std::getline(in, line);)
        if (std::regex_search(line, match, line_form))
          found.push_back({fs::relative(entry.path(), ALVOR_SOURCE).string(), match[1]});
    }
  return found;
}

std::string first_folder(const std::string& path) { return path.substr(0, path.find('/')); }

TEST(Includes, ArrowsPointDownTheLayers) {
  const auto includes = all_includes();
  EXPECT_GT(includes.size(), 100u);
  for (const auto& [file, target] : includes) {
    const std::string from = first_folder(file), to = first_folder(target);
    if (!allowed.contains(to) || to == from) continue;
    EXPECT_TRUE(allowed.at(from).contains(to) || exceptions.contains({file, to})) << file << " includes " << target;
  }
}

TEST(Includes, LibrariesStayBehindTheirFolders) {
  for (const auto& [file, target] : all_includes())
    for (const auto& [library, place] : kept_behind) {
      if (target.rfind(library, 0) != 0) continue;
      EXPECT_EQ(file.rfind(place, 0), 0u) << file << " includes " << target;
    }
}

TEST(Includes, EveryExceptionIsStillNeeded) {
  std::set<std::pair<std::string, std::string>> used;
  for (const auto& [file, target] : all_includes()) used.insert({file, first_folder(target)});
  for (const auto& exception : exceptions)
    EXPECT_TRUE(used.contains(exception)) << exception.first << " no longer includes " << exception.second << '/';
}

}  // namespace
