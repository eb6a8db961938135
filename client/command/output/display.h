#pragma once
// Makes display meshes from a mirror's leaves.

#include "client/command/output/snapshots.h"
#include "meshing/display_mesh.h"

#include <span>
#include <vector>

namespace alvor {

/// Leaves that cover all roots of a mesh, and their told errors or none.
struct CoveringLeaves {
  std::vector<LeafValue> leaves;
  std::vector<float> errors;
};

/// Returns leaves with a dark one for each root that has none. If some errors are NaN, none are returned.
CoveringLeaves covering_leaves(const BaseMesh& mesh, std::span<const LeafValue> leaves, std::span<const float> errors);

/// Returns the solution as it is written to files, without ambient term. Root patches without leaves are dark. `errors` are the
/// told errors of the leaves; if some are NaN, the mesh has none.
DisplayMesh solution_mesh(const BaseMesh& mesh, std::span<const LeafValue> leaves, std::span<const float> errors = {});

/// Returns a moment for display: the ambient term is added everywhere except where the final state `last` is exactly dark. Such
/// leaves are hidden under or inside something, and their light would leak out along the contact line.
DisplayMesh shown_mesh(const BaseMesh& mesh, const Snapshot& moment, const Snapshot& last);

/// Returns a moment for display while the final state is not known: the ambient term is added everywhere.
DisplayMesh brightened_mesh(const BaseMesh& mesh, const Snapshot& moment);

}  // namespace alvor
