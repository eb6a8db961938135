#pragma once
// Small display meshes made without a solver.

#include "meshing/display_mesh.h"

#include <array>
#include <cstdint>

namespace alvor {

inline RgbF grey(float value) { return {value, value, value}; }

/// Adds a leaf as build_display_mesh does: (centre, corner, next corner), counter-clockwise seen from the front. `radiosity_at`
/// returns the radiosity at a position; irradiance is twice that, as for reflectance 0.5.
template <class Field>
void add_leaf(DisplayMesh& mesh, const std::array<Vec3, 4>& corners, Field radiosity_at) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  const Vec3 normal = normalized(cross(corners[1] - corners[0], corners[2] - corners[0]));
  const Vec3 centre = 0.25 * (corners[0] + corners[1] + corners[2] + corners[3]);
  for (const Vec3& p : {centre, corners[0], corners[1], corners[2], corners[3]}) {
    mesh.positions.push_back(p);
    mesh.normals.push_back(normal);
    mesh.radiosity.push_back(radiosity_at(p));
    mesh.irradiance.push_back(2 * mesh.radiosity.back());
  }
  for (std::uint32_t k = 0; k < 4; ++k) mesh.triangles.push_back({first, first + 1 + k, first + 1 + (k + 1) % 4});
}

/// Adds a wall of n x n leaves, from corner `a` along the sides `ab` and `ad`.
template <class Field>
void add_wall(DisplayMesh& mesh, Vec3 a, Vec3 ab, Vec3 ad, int n, Field radiosity_at) {
  for (int i = 0; i < n * n; ++i) {
    const Vec3 low = a + ab * (double(i % n) / n) + ad * (double(i / n) / n);
    add_leaf(mesh, {low, low + ab / n, low + ab / n + ad / n, low + ad / n}, radiosity_at);
  }
}

/// A box of 4 x 3 x 5 m seen from inside, brighter at the top, with a gradient on its walls and an emitting lamp under its
/// ceiling.
struct Room {
  Vec3 origin{};
  bool front_open = true;  ///< the side z = 0
  int leaves_per_side = 6;
  float brightness = 1;
};

inline DisplayMesh hand_made_room(const Room& room = {}) {
  DisplayMesh mesh;
  const int n = room.leaves_per_side;
  const Vec3 o = room.origin, x{4, 0, 0}, y{0, 3, 0}, z{0, 0, 5};
  const auto tinted = [&](RgbF tint) {
    return [=](const Vec3& p) { return static_cast<float>(0.1 + 0.2 * (p.y - o.y)) * room.brightness * tint; };
  };
  const RgbF white{1, 1, 1}, red{1, 0.15f, 0.1f}, green{0.15f, 0.8f, 0.2f};
  add_wall(mesh, o, z, x, n, tinted(white));      // floor
  add_wall(mesh, o + y, x, z, n, tinted(white));  // ceiling
  add_wall(mesh, o + z, y, x, n, tinted(white));  // back
  add_wall(mesh, o, y, z, n, tinted(green));      // x = 0
  add_wall(mesh, o + x, z, y, n, tinted(red));    // x = 4
  if (!room.front_open) add_wall(mesh, o, x, y, n, tinted(white));
  const std::size_t lamp = mesh.positions.size();
  add_leaf(mesh, {o + Vec3{1.5, 2.95, 2}, o + Vec3{2.5, 2.95, 2}, o + Vec3{2.5, 2.95, 3}, o + Vec3{1.5, 2.95, 3}},
           [&](const Vec3&) { return grey(20 * room.brightness); });
  for (std::size_t i = lamp; i < mesh.positions.size(); ++i) mesh.irradiance[i] = grey(0.1f * room.brightness);
  return mesh;
}

}  // namespace alvor
