#pragma once

#include "meshing/scene.h"
#include "tests/random/dice.h"

namespace alvor::test {

/// Adds a room with things in it, some solids in the open, or a soup of polygons, about one unit large. No two of its faces lie
/// in the same plane, but they may cross. Requires: materials.
void add_random_faces(Dice& dice, Scene& scene);

Vec3 random_point(Dice& dice);

}  // namespace alvor::test
