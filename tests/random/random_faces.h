#pragma once

#include "meshing/scene.h"
#include "tests/random/dice.h"

namespace alvor::test {

/// Adds a room with objects, some solids in the open, or random polygons, about one unit large. No two faces lie in one plane,
/// but they may cross. Requires: the scene has materials.
void add_random_faces(Dice& dice, Scene& scene);

Vec3 random_point(Dice& dice);

}  // namespace alvor::test
