#pragma once
// Scenes as no architect would draw them, but files hold.

#include "meshing/scene.h"

namespace alvor::bench {

/// A room whose ceiling has a lamp, with a block on the floor.
Scene lit_room();
/// A lamp of a square micrometre in a room of a square metre a wall.
Scene small_lamp_in_large_room();

// A closed room in which all emits 1 and reflects half, with something more:
Scene slivers();
Scene every_face_twice();
Scene back_to_back();
Scene overlapping_coplanar();
Scene floors_a_hair_apart();
Scene block_a_hair_above_the_floor();
Scene touching_blocks();
Scene crossing_blocks();
Scene fan_on_one_edge();
Scene cones();
Scene hardly_bent();
Scene clearly_bent();
Scene with_degenerate_faces();

// Nothing is lit.
Scene inside_out();
Scene one_face();

// To be refused.
Scene all_degenerate();
Scene beyond_the_world();
Scene not_a_number();

}  // namespace alvor::bench
