#pragma once
// Writes generated scenes as Wavefront OBJ and MTL. Lengths are metres, y is up.

#include "meshing/vec3.h"

#include <map>
#include <span>
#include <string>
#include <string_view>

namespace alvor::bench {

// The faces of a box, as bits for leaving some out. Where one object lies flat on a larger one, the smaller face is left out, so
// that no faces coincide.
constexpr unsigned bottom = 1, top = 2, x_low = 4, x_high = 8, z_low = 16, z_high = 32;

/// The position and orientation of an object in the scene.
struct Place {
  double x = 0, z = 0;      ///< on the floor, metres
  double turn_degrees = 0;  ///< about the vertical, counter-clockwise from above
  double y = 0;             ///< height above the floor, metres
};

/// Returns `inner`, given relative to `outer`, relative to the scene.
Place placed_in(const Place& outer, const Place& inner);

/// A material of the MTL file: its name and the lines that follow it.
struct Paint {
  const char* name;
  const char* lines;
};

/// Collects the text of an OBJ file.
class ObjWriter {
 public:
  /// Coordinates of later calls are relative to this place.
  void stand_at(const Place& place);

  /// Begins an object of this name, which no other has: later faces belong to it.
  void object(const std::string& name);
  /// Begins an object with this name and a number from 1: "desk.001".
  void numbered_object(const std::string& name);

  /// Adds a box: a solid with its fronts outwards, or a room with its fronts inwards. `left_out` names faces to leave out.
  void box(const char* material, Vec3 low, Vec3 high, unsigned left_out = 0, bool inwards = false);

  /// Adds a vertex and returns the index by which faces name it.
  int vertex(const Vec3& at);
  /// Adds a face. Requires: three vertices or more, counter-clockwise seen from the front.
  void face(const char* material, std::span<const int> ring);

  int face_count() const { return face_count_; }
  std::string_view text() const { return text_; }

 private:
  void coordinate(double metres);

  std::string text_;
  std::map<std::string, int> numbers_;  ///< of the newest object of each name
  std::string_view material_;
  Place place_;
  double cosine_ = 1, sine_ = 0;
  int vertex_count_ = 0, face_count_ = 0;
};

/// Writes `path`, which ends in .obj, and the MTL file of the same name beside it. Returns false, after a line on stderr, if it
/// cannot.
bool write_scene(const std::string& path, std::span<const Paint> paints, const ObjWriter& obj);

}  // namespace alvor::bench
