#pragma once

#include "meshing/scene.h"
#include "tests/random/dice.h"

#include <string>

namespace alvor::test {

/// Adds faces as nobody should draw them: slivers, specks, degenerate, bent, concave, doubled, coplanar ones. False if some now
/// lie in the plane of others that they overlap. Requires: faces.
bool add_flaws(Dice& dice, Scene& scene);

/// Makes the scene one that must be refused, and returns the place that the refusal must name. Requires: faces.
std::string add_fault(Dice& dice, Scene& scene);

}  // namespace alvor::test
