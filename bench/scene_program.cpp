#include "bench/scene_program.h"

#include <iostream>

namespace alvor::bench {

int run_scene_program(int count, char** arguments, const std::string& name, std::span<const Paint> paints, ObjWriter (*scene)()) {
  if (count != 2) return std::cerr << "usage: " << name << " DIR\n", 2;
  const ObjWriter obj = scene();
  if (!write_scene(std::string(arguments[1]) + "/" + name + ".obj", paints, obj)) return 1;
  std::cout << obj.face_count() << " faces\n";
  return 0;
}

}  // namespace alvor::bench
