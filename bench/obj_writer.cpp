#include "bench/obj_writer.h"

#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <numbers>

namespace alvor::bench {

namespace {

double radians(double degrees) { return degrees * std::numbers::pi / 180; }

bool write(const std::string& path, std::string_view head, std::string_view text) {
  std::ofstream out(path, std::ios::binary);
  out << head << text << std::flush;
  if (!out) std::cerr << path << " cannot be written\n";
  return out.good();
}

}  // namespace

Place placed_in(const Place& outer, const Place& inner) {
  const double c = std::cos(radians(outer.turn_degrees)), s = std::sin(radians(outer.turn_degrees));
  return {outer.x + c * inner.x + s * inner.z, outer.z - s * inner.x + c * inner.z, outer.turn_degrees + inner.turn_degrees,
          outer.y + inner.y};
}

void ObjWriter::stand_at(const Place& place) {
  place_ = place;
  cosine_ = std::cos(radians(place.turn_degrees));
  sine_ = std::sin(radians(place.turn_degrees));
}

void ObjWriter::object(const std::string& name) { text_.append("o ").append(name).append("\n"); }

void ObjWriter::numbered_object(const std::string& name) {
  const std::string number = std::to_string(++numbers_[name]);
  object(name + '.' + std::string(number.size() < 3 ? 3 - number.size() : 0, '0') + number);
}

void ObjWriter::box(const char* material, Vec3 low, Vec3 high, unsigned left_out, bool inwards) {
  const int first = vertex_count_ + 1;
  for (const double y : {low.y, high.y}) {
    vertex({low.x, y, low.z});
    vertex({high.x, y, low.z});
    vertex({high.x, y, high.z});
    vertex({low.x, y, high.z});
  }
  constexpr std::array<std::array<int, 4>, 6> outwards{
      {{0, 1, 2, 3}, {7, 6, 5, 4}, {0, 3, 7, 4}, {2, 1, 5, 6}, {1, 0, 4, 5}, {3, 2, 6, 7}}};
  for (unsigned side = 0; side < 6; ++side) {
    if (left_out >> side & 1) continue;
    const auto [a, b, c, d] = outwards[side];
    const std::array<int, 4> ring{first + a, first + b, first + c, first + d};
    face(material, inwards ? std::array{ring[3], ring[2], ring[1], ring[0]} : ring);
  }
}

int ObjWriter::vertex(const Vec3& at) {
  text_ += 'v';
  coordinate(place_.x + cosine_ * at.x + sine_ * at.z);
  coordinate(place_.y + at.y);
  coordinate(place_.z - sine_ * at.x + cosine_ * at.z);
  text_ += '\n';
  return ++vertex_count_;
}

// Appends a coordinate, rounded to a tenth of a millimetre, which suits furniture and keeps files small. printf would take most
// of the time of large scenes.
void ObjWriter::coordinate(double metres) {
  std::array<char, 40> digits;
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), metres, std::chars_format::fixed, 4).ptr;
  text_.append(1, ' ').append(digits.data(), end);
}

void ObjWriter::face(const char* material, std::span<const int> ring) {
  if (material != material_) text_.append("usemtl ").append(material_ = material).append("\n");
  text_ += 'f';
  for (const int corner : ring) text_.append(1, ' ').append(std::to_string(corner));
  text_ += '\n';
  ++face_count_;
}

bool write_scene(const std::string& path, std::span<const Paint> paints, const ObjWriter& obj) {
  const auto mtl = std::filesystem::path(path).replace_extension(".mtl");
  std::string materials;
  for (const auto& [name, lines] : paints) materials.append("newmtl ").append(name).append("\n").append(lines).append("\n");
  return write(mtl.string(), materials, "") && write(path, "mtllib " + mtl.filename().string() + "\n", obj.text());
}

}  // namespace alvor::bench
