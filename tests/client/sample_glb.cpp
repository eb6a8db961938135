// sample_glb FILE: writes a solution far from the origin, for the glTF validator.

#include "client/export/solution_file.h"
#include "tests/client/hand_made_mesh.h"

int main(int count, char** arguments) {
  if (count != 2) return 2;
  alvor::write_solution_file(arguments[1], alvor::hand_made_room({.origin = {1e6, -2e5, 3e6}}));
}
