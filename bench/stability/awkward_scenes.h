#pragma once
// Awkward scenes that real files contain though no architect would draw them.

#include "meshing/scene.h"

namespace alvor::bench {

/// Returns a room with a lamp in its ceiling and a block on its floor.
Scene lit_room();
/// Returns a room with a lamp of a square micrometre and walls of a square metre.
Scene small_lamp_in_large_room();

// Closed rooms in which every surface emits 1 and reflects half, with one awkward addition each:
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

// Scenes in which nothing is lit:
Scene inside_out();
Scene one_face();

// Scenes that must be refused:
Scene all_degenerate();
Scene beyond_the_world();
Scene not_a_number();

}  // namespace alvor::bench
