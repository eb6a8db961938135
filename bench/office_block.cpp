// office_block --faces N -o FILE.obj [--seed S] [--lamps-per-1000-faces L]: writes FILE.obj and FILE.mtl, a furnished office
// block of about N faces. The same arguments give the same output.

#include "bench/office.h"

#include <cstdlib>
#include <iostream>
#include <string>

namespace {

constexpr const char* usage =
    "usage: office_block --faces N -o FILE.obj [--seed S] [--lamps-per-1000-faces L]; N from 100 to 5000000, L from 0 to 100\n";

struct Arguments {
  alvor::bench::OfficeOptions office{.faces = 0};
  std::string path;
};

/// Reads one option. Returns false if it is unknown.
bool read_option(const std::string& name, const char* value, Arguments& into) {
  if (name == "--faces") into.office.faces = std::atoi(value);
  else if (name == "--seed") into.office.seed = static_cast<unsigned>(std::strtoul(value, nullptr, 10));
  else if (name == "--lamps-per-1000-faces") into.office.lamps_per_1000_faces = std::atof(value);
  else if (name == "-o") into.path = value;
  else return false;
  return true;
}

bool is_usable(const Arguments& arguments) {
  const auto& office = arguments.office;
  return office.faces >= 100 && office.faces <= 5'000'000 && office.lamps_per_1000_faces >= 0 &&
         office.lamps_per_1000_faces <= 100 && arguments.path.ends_with(".obj");
}

}  // namespace

int main(int count, char** values) {
  Arguments arguments;
  bool is_known = count % 2 == 1;
  for (int k = 1; is_known && k + 1 < count; k += 2) is_known = read_option(values[k], values[k + 1], arguments);
  if (!is_known || !is_usable(arguments)) return std::cerr << usage, 2;
  const alvor::bench::OfficeBlock block = alvor::bench::office_block(arguments.office);
  if (!alvor::bench::write_scene(arguments.path, alvor::bench::office_paints(), block.obj)) return 1;
  std::cout << block.obj.face_count() << " faces, " << block.lamps << " of them lamps; rooms: " << block.rooms
            << ", storeys: " << block.storeys << '\n';
}
