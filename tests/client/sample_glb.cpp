// sample_glb FILE [textured]: writes a solution far from the origin, for the glTF validator; with a texture if that is said.

#include "client/export/solution_file.h"
#include "tests/client/hand_made_mesh.h"
#include "tests/scenes.h"
#include "tests/textures.h"

int main(int count, char** arguments) {
  if (count != 2 && count != 3) return 2;
  alvor::DisplayMesh mesh = alvor::hand_made_room({.origin = {1e6, -2e5, 3e6}});
  if (count == 3) {
    mesh.materials = {alvor::test::grey(0, 0.5), alvor::test::textured(alvor::test::noise(9, 5))};
    mesh.texture_points.assign(mesh.positions.size(), {0.25F, -3});
    const auto all = static_cast<std::uint32_t>(mesh.triangles.size());
    mesh.faces = {{{0}, 0, 4}, {{1}, 1, 8}, {{2}, 0, all - 12}};
  }
  alvor::write_solution_file(arguments[1], mesh);
}
