#pragma once
// A small room with a lamp as OBJ and MTL, for tests of the command.

#include <string>

namespace alvor::test {

/// Returns an OBJ of a room of 8 quads, wall by wall, with a lamp under its ceiling and a screen; `more` is appended.
inline std::string room_of_eight(const std::string& more = "") {
  return "mtllib room.mtl\nv 0 0 0\nv 4 0 0\nv 4 0 5\nv 0 0 5\nv 0 3 0\nv 4 3 0\nv 4 3 5\nv 0 3 5\n"
         "v 1 2.9 2\nv 3 2.9 2\nv 3 2.9 3\nv 1 2.9 3\nv 1 0.5 1\nv 3 0.5 1\nv 3 2 1\nv 1 2 1\n"
         "usemtl white\nf 4 3 2 1\nf 5 6 7 8\nf 1 5 8 4\nf 2 3 7 6\nf 1 2 6 5\nf 3 4 8 7\nusemtl lamp\nf 9 10 11 12\n"
         "usemtl white\nf 13 14 15 16\n" +
         more;
}
/// The text of room.mtl, which the room of eight names.
inline const std::string room_materials = "newmtl white\nKd 0.5 0.5 0.5\nnewmtl lamp\nKd 0 0 0\nKe 10 10 10\n";

}  // namespace alvor::test
