#pragma once
// The part of an edited scene that no edit has hidden.

#include "meshing/scene.h"

namespace alvor {

/// Returns what is there of an edited scene, as a scene of its own: without hidden objects, their faces and their lamps, and with
/// the vertices of the faces that remain. Materials keep their numbers. Requires: !find_fault(edited).
Scene present_scene(const Scene& edited);

}  // namespace alvor
