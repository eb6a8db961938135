#pragma once
// Wavefront OBJ and MTL of generated scenes. Lengths are metres, y is up.

#include "meshing/vec3.h"

#include <span>
#include <string>
#include <string_view>

namespace alvor::bench {

// Faces of a box, to be left out: where one thing lies flat on a larger one, the smaller face is, so that nothing is coincident.
constexpr unsigned bottom = 1, top = 2, x_low = 4, x_high = 8, z_low = 16, z_high = 32;

struct Place {
  double x = 0, z = 0;      ///< on the floor, metres
  double turn_degrees = 0;  ///< about the vertical, counter-clockwise from above
  double y = 0;             ///< above the floor
};

/// Where `inner`, given from `outer`, is.
Place placed_in(const Place& outer, const Place& inner);

/// A material: its name and the lines that follow it.
struct Paint {
  const char* name;
  const char* lines;
};

class ObjWriter {
 public:
  /// From here on coordinates are seen from this place.
  void stand_at(const Place& place);

  /// Solid, fronts outwards; or a room, fronts inwards.
  void box(const char* material, Vec3 low, Vec3 high, unsigned left_out = 0, bool inwards = false);

  /// The index that faces name it by.
  int vertex(const Vec3& at);
  /// Requires: three vertices or more, counter-clockwise seen from the front.
  void face(const char* material, std::span<const int> ring);

  int face_count() const { return face_count_; }
  std::string_view text() const { return text_; }

 private:
  void coordinate(double metres);

  std::string text_;
  std::string_view material_;
  Place place_;
  double cosine_ = 1, sine_ = 0;
  int vertex_count_ = 0, face_count_ = 0;
};

/// Writes `path`, which ends in .obj, and the MTL file of the same name beside it. False, with a line on stderr, if it cannot.
bool write_scene(const std::string& path, std::span<const Paint> paints, const ObjWriter& obj);

}  // namespace alvor::bench
