// Fuzzes the files that our own importers read: OBJ, MTL, glTF and GLB with their parts; GLB and PLY of a solution; IES and
// EULUMDAT.

#include "client/export/solution_file.h"
#include "import/base/import_error.h"
#include "import/base/whole_file.h"
#include "import/formats/import_scene.h"
#include "import/photometry/luminaire_file.h"
#include "tests/fuzz/input.h"

#include <unistd.h>

#include <array>
#include <cstdlib>
#include <fstream>

namespace {

namespace fs = std::filesystem;

/// Returns a folder with files of Blender's exporters, so that a made-up scene can name existing parts.
const fs::path& directory() {
  static const auto made = [] {
    auto path = fs::path("/dev/shm") / ("alvor_fuzz_" + std::to_string(getpid()));
    fs::create_directories(path);
    fs::copy(ALVOR_TEST_FILES "/import/blender/files", path, fs::copy_options::overwrite_existing);
    return path;
  }();
  return made;
}

/// A file that is written, and the file that is then read.
struct Kind {
  const char *written, *read;
  bool is_solution = false;
};
constexpr std::array<const char*, 2> luminaires{".ies", ".ldt"};  // numbered after the kinds
constexpr std::array<Kind, 8> kinds{{{"scene.obj", "scene.obj"},
                                     {"scene.gltf", "scene.gltf"},
                                     {"scene.glb", "scene.glb"},
                                     {"solution.glb", "solution.glb", true},
                                     {"solution.ply", "solution.ply", true},
                                     {"room_z_up.mtl", "room_z_up.obj"},
                                     {"room.bin", "room.gltf"},
                                     {"wood.png", "room.obj"}}};

/// Reads a scene in this process, with all files of the folder.
void read_scene(const Kind& kind) {
  alvor::SceneFiles files(kind.read, alvor::read_whole_file(directory() / kind.read));
  for (const auto& entry : fs::directory_iterator(directory()))
    files.add(entry.path().filename().string(), alvor::read_whole_file(entry.path()));
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

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::size_t number = data[0] % (kinds.size() + luminaires.size());
  if (number >= kinds.size()) {
    try {
      read_luminaire({reinterpret_cast<const char*>(data + 1), size - 1}, luminaires[number - kinds.size()]);
    } catch (const alvor::ImportError&) {}
    return 0;
  }
  const Kind& kind = kinds[number];
  std::ofstream(directory() / kind.written, std::ios::binary)
      .write(reinterpret_cast<const char*>(data + 1), static_cast<std::streamsize>(size - 1));
  try {
    if (kind.is_solution) (void)alvor::read_solution_file(directory() / kind.read);
    else read_scene(kind);
  } catch (const alvor::ImportError&) {
  } catch (const alvor::SolutionFileError&) {}
  return 0;
}
