// sample_glb FILE [textured | cut_out]: writes a solution far from the origin, for the glTF validator: plain, with a texture, or
// with a texture that has holes on a translucent material.

#include "client/export/solution_file.h"
#include "tests/client/hand_made_mesh.h"
#include "tests/cutouts.h"
#include "tests/scenes.h"

#include <string_view>

int main(int count, char** arguments) {
  if (count != 2 && count != 3) return 2;
  alvor::DisplayMesh mesh = alvor::hand_made_room({.origin = {1e6, -2e5, 3e6}});
  if (count == 3) {
    const bool is_cut_out = std::string_view(arguments[2]) == "cut_out";
    const alvor::ColourImage image = alvor::test::noise(9, 5);
    mesh.materials = {alvor::test::grey(0, 0.5), alvor::test::textured(is_cut_out ? alvor::test::with_holes(image) : image)};
    if (is_cut_out) {
      mesh.materials[1].two_sided = true;
      mesh.materials[1].diffuse_transmittance = {0.005, 0.004, 0.003};
      mesh.transmitted.assign(mesh.positions.size(), {0.01F, 0.02F, 0});
    }
    mesh.texture_points.assign(mesh.positions.size(), {0.25F, -3});
    const auto all = static_cast<std::uint32_t>(mesh.triangles.size());
    mesh.faces = {{{0}, 0, 4}, {{1}, 1, 8}, {{2}, 0, all - 12}};
  }
  alvor::write_solution_file(arguments[1], mesh);
}
