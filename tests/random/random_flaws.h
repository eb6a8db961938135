#pragma once

#include "meshing/scene.h"
#include "tests/random/dice.h"

#include <string>

namespace alvor::test {

/// Adds bad faces: slivers, specks, degenerate, non-planar, concave, doubled and coplanar ones. Returns false if some now overlap
/// others in their plane. Requires: the scene has faces.
bool add_flaws(Dice& dice, Scene& scene);

/// Changes the scene so that it must be refused, and returns the place that the refusal must name. Requires: the scene has faces.
std::string add_fault(Dice& dice, Scene& scene);

}  // namespace alvor::test
