// Fuzzes the files that our own importers read: OBJ, MTL, glTF and GLB with their parts; GLB, PLY and compact files of a
// solution; IES and EULUMDAT; environment maps. The first byte of an input chooses what the others are.

#include "client/export/solution_file.h"
#include "import/base/import_error.h"
#include "import/base/whole_file.h"
#include "import/environment/bright_spots.h"
#include "import/environment/environment_file.h"
#include "import/formats/import_scene.h"
#include "import/photometry/luminaire_file.h"
#include "tests/fuzz/input.h"

#include <array>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>

namespace {

namespace fs = std::filesystem;

/// A made-up file, and the scene file that is read with it. They are the same if the scene file is made up.
struct SceneKind {
  const char *made_up, *scene;
};
// The numbers of kinds are those of tests/fuzz/seeds.cpp.
constexpr std::array<SceneKind, 6> scenes{{{"scene.obj", "scene.obj"},
                                           {"scene.gltf", "scene.gltf"},
                                           {"scene.glb", "scene.glb"},
                                           {"room_z_up.mtl", "room_z_up.obj"},
                                           {"room.bin", "room.gltf"},
                                           {"wood.png", "room.obj"}}};
constexpr std::array<const char*, 3> solutions{".glb", ".ply", ".alvor"};  // numbered after the scenes
constexpr std::array<const char*, 2> luminaires{".ies", ".ldt"};           // numbered after the solutions
constexpr std::array<const char*, 2> environments{".hdr", ".exr"};         // numbered after the luminaires

/// Returns the files of Blender's exporters by name. A made-up scene can name them as its parts.
const std::map<std::string, std::string>& parts() {
  static const auto read = [] {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::directory_iterator(ALVOR_TEST_FILES "/import/blender/files"))
      files.emplace(entry.path().filename().string(), alvor::read_whole_file(entry.path()));
    return files;
  }();
  return read;
}

/// Reads a scene in this process, where one of its files is made up. Files that are missing are then declared absent.
void read_scene(const SceneKind& kind, const std::string& bytes) {
  const bool is_scene = kind.made_up == std::string_view(kind.scene);
  alvor::SceneFiles files(kind.scene, is_scene ? bytes : parts().at(kind.scene));
  for (const auto& [name, part] : parts()) files.add(name, part);
  files.add(kind.made_up, bytes);
  const auto missing = alvor::import_scene(files, {}).missing;
  for (const std::string& name : missing) files.declare_absent(name);
  if (!missing.empty()) (void)alvor::import_scene(files, {});
}

/// Reads a photometric file; what was read can be asked for its light.
void read_luminaire(std::string_view bytes, const char* extension) {
  const alvor::LuminaireFile file = alvor::read_luminaire(bytes, extension);
  double sum = file.web->flux();
  for (const alvor::Vec3 direction : {alvor::Vec3{0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {0.6, -0.8, 0}})
    sum += file.web->intensity(direction);
  if (!(sum > 0)) std::abort();
}

/// Reads an environment map, which then is sound. OpenEXR throws exceptions of its own.
void read_environment(const std::string& bytes, const char* extension) try {
  alvor::EnvironmentFile file = alvor::read_environment(bytes, extension);
  (void)alvor::take_bright_spots(file.map);
  if (fault_in(alvor::reduced(file.map, alvor::EnvironmentMap::most_columns, alvor::EnvironmentMap::most_rows))) std::abort();
} catch (const alvor::ImportError&) {
  throw;
} catch (const std::exception&) {}

void read_file(std::size_t kind, const std::string& bytes) {
  if (kind < scenes.size()) return read_scene(scenes[kind], bytes);
  kind -= scenes.size();
  if (kind < solutions.size()) return (void)alvor::decode_solution(bytes, solutions[kind], "made up");
  kind -= solutions.size();
  if (kind < luminaires.size()) return read_luminaire(bytes, luminaires[kind]);
  read_environment(bytes, environments[kind - luminaires.size()]);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  try {
    read_file(data[0] % (scenes.size() + solutions.size() + luminaires.size() + environments.size()),
              {reinterpret_cast<const char*>(data + 1), size - 1});
  } catch (const alvor::ImportError&) {
  } catch (const alvor::SolutionFileError&) {}
  return 0;
}
