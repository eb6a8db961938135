#pragma once

#include "meshing/scene.h"
#include "tests/random/dice.h"

namespace alvor::test {

/// Adds a room with things in it, some solids in the open, or a soup of polygons, about one unit large. No two of its faces lie
/// in the same plane, but they may cross. Requires: materials.
void add_random_faces(Dice& dice, Scene& scene);

Vec3 random_point(Dice& dice);

/// Adds a polygon with vertices of its own.
void add_ring(Scene& scene, std::span<const Vec3> ring, std::uint32_t material);

}  // namespace alvor::test
