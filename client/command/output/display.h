#pragma once
// From a mirror's leaves to what is drawn.

#include "client/command/output/snapshots.h"
#include "meshing/display_mesh.h"

#include <span>
#include <vector>

namespace alvor {

/// The solution as it is written to files: no ambient term. Root patches that `leaves` says nothing about are dark.
DisplayMesh solution_mesh(const BaseMesh& mesh, std::span<const LeafValue> leaves);

/// A moment as it is shown: its ambient term is added everywhere but where `last`, the final state, is exactly dark. Those
/// leaves are hidden under or inside something, and light there would leak out along the contact.
DisplayMesh shown_mesh(const BaseMesh& mesh, const Snapshot& moment, const Snapshot& last);

/// The same while the final state is not known: the ambient term is added everywhere.
DisplayMesh brightened_mesh(const BaseMesh& mesh, const Snapshot& moment);

}  // namespace alvor
