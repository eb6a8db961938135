// Scene and solution files that are read by our own importers: OBJ, glTF and GLB, GLB and PLY of a solution.

#include "client/scene_file.h"
#include "client/solution_file.h"
#include "tests/fuzz/input.h"

#include <unistd.h>

#include <array>
#include <fstream>

namespace {

const std::filesystem::path& directory() {
  static const auto made = [] {
    auto path = std::filesystem::path("/dev/shm") / ("alvor_fuzz_" + std::to_string(getpid()));
    std::filesystem::create_directories(path);
    return path;
  }();
  return made;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  static constexpr std::array names{"scene.obj", "scene.gltf", "scene.glb", "solution.glb", "solution.ply", "scene.mtl"};
  const std::size_t kind = data[0] % names.size();
  const auto path = directory() / names[kind];
  std::ofstream(path, std::ios::binary).write(reinterpret_cast<const char*>(data + 1), static_cast<std::streamsize>(size - 1));
  try {
    if (kind == 3 || kind == 4) (void)alvor::read_solution_file(path);
    else if (kind == 5)
      std::ofstream(directory() / "scene.obj") << "mtllib scene.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n";
    if (kind < 3 || kind == 5) (void)alvor::read_scene_file(kind == 5 ? directory() / "scene.obj" : path);
  } catch (const alvor::SceneFileError&) {
  } catch (const alvor::SolutionFileError&) {}
  return 0;
}
