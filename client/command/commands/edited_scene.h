#pragma once

#include "client/rpc/client.h"
#include "meshing/base_mesh.h"
#include "solution/solution_mirror.h"

#include <cstdint>
#include <optional>
#include <string>

namespace alvor {

/// A scene as edits have made it, hidden objects included, and its mesh.
struct EditedScene {
  Scene scene;
  BaseMesh mesh;
};

/// Returns the scene of a solve as its edits up to a revision (Step::edits of a state) have made it, or all of them. Throws
/// RpcError, ABORTED where the step of that revision is no more, because a slide went on; and Failure (usage) if `solve` is not
/// the name of a solve.
EditedScene read_edited(Client& client, const std::string& solve, std::optional<std::uint64_t> edits);
/// Returns the mesh of that scene, to be shown: where the step of that revision is no more, it warns and returns the mesh with
/// all edits. Throws as read_edited().
BaseMesh read_edited_mesh(Client& client, const std::string& solve, std::optional<std::uint64_t> edits);
/// Returns the same mesh without reading the scene as submitted, whose mesh is `submitted`.
BaseMesh read_edited_mesh(Client& client, BaseMesh submitted, const std::string& solve, std::optional<std::uint64_t> edits);

/// Returns the revision of the edits that a mirror's leaves heed; nothing while frames are under way, some of whose leaves may
/// heed newer edits: then draw with all.
std::optional<std::uint64_t> edits_shown(const SolutionMirror& mirror);

}  // namespace alvor
