#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

// The layers: the folders that a folder may include besides itself, and the few files that may include more;
// docs/design/structure.md says why.
const std::map<std::string, std::set<std::string>> allowed{
    {"solution", {}},
    {"meshing", {"solution"}},
    {"radiosity", {"meshing", "solution"}},
    {"proto", {"solution", "meshing"}},
    {"import", {"meshing", "solution", "proto"}},
    {"server", {"radiosity", "meshing", "solution", "proto", "import"}},
    {"client", {"solution", "meshing", "proto", "import"}},
};
// The rooms of a folder from the lowest to the highest: a file includes files of its own room and of lower ones.
const std::map<std::string, std::vector<std::string>> rooms{
    {"import", {"base", "environment", "photometry", "apart", "formats", "program"}},
    {"radiosity", {"ranks", "rays", "form_factors", "direct", "exchange", "estimate", "plan", "solve"}},
    {"server", {"base", "archive", "scenes", "solves", "watch", "access", "rpc", "web"}},
    {"client", {"picture", "export", "rpc", "verify", "bake", "report", "command"}},
    {"client/command", {"output", "options", "commands"}},
};
const std::set<std::pair<std::string, std::string>> exceptions{
    {"client/rpc/in_process.cpp", "server"},
    {"client/verify/gather.cpp", "radiosity"},
    {"client/verify/gather.h", "radiosity"},
    {"client/verify/probe.cpp", "radiosity"},
    {"client/verify/sight_line.h", "radiosity"},
    {"client/bake/solved_surface.h", "radiosity"},
    {"client/picture/stage.h", "radiosity"},
    {"client/picture/camera.cpp", "radiosity"},
    {"client/verify/path_tracer.cpp", "radiosity"},
    {"client/command/commands/compare_command.cpp", "radiosity"},
    {"client/command/commands/explain_command.cpp", "radiosity"},
    {"client/command/commands/form_factor_command.cpp", "radiosity"},
    {"client/command/commands/form_factors_command.cpp", "radiosity"},
    {"client/command/commands/solve_here.h", "radiosity"},
    {"client/report/floor_survey.h", "radiosity"},
};
// Libraries, and a header that wraps one, that only one folder or file may include.
const std::map<std::string, std::string> kept_behind{
    {"embree", "radiosity/rays/embree_scene.h"},
    {"radiosity/rays/embree_scene.h", "radiosity/rays/"},
    {"OpenMesh/", "meshing/base_mesh.cpp"},
    {"spdlog/", "server/"},
    {"SQLiteCpp/", "server/archive/"},
    {"sqlite3.h", "server/archive/"},
    {"boost/", "server/web/"},
    {"assimp/", "import/formats/"},
    {"seccomp.h", "import/program/"},
    {"mpi.h", "radiosity/ranks/mpi_ranks.cpp"},
    {"webp/", "import/formats/image_file.cpp"},
};

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

/// Returns the height of `path`'s room in `folder`, or -1 if it is in none.
int height(const std::string& path, const std::string& folder) {
  if (!path.starts_with(folder + "/")) return -1;
  const std::string rest = path.substr(folder.size() + 1), room = first_folder(rest);
  const auto& order = rooms.at(folder);
  const auto found = std::ranges::find(order, room);
  return rest == room || found == order.end() ? -1 : static_cast<int>(found - order.begin());
}

TEST(Includes, ArrowsBetweenRoomsPointDown) {
  for (const auto& [file, target] : all_includes())
    for (const auto& [folder, order] : rooms) {
      const int from = height(file, folder), to = height(target, folder);
      EXPECT_TRUE(from < 0 || to <= from) << file << " includes " << target;
    }
}

TEST(Includes, EveryFileOfAFolderWithRoomsIsInOne) {
  const std::set<std::string> programs{"server/main.cpp", "server/server_options.cpp", "server/server_options.h",
                                       "client/command/main.cpp"};
  for (const auto& [file, target] : all_includes())
    for (const auto& [folder, order] : rooms)
      EXPECT_TRUE(!file.starts_with(folder + "/") || height(file, folder) >= 0 || programs.contains(file)) << file;
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
