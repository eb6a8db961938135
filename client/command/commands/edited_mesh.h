#pragma once

#include "client/rpc/client.h"
#include "meshing/base_mesh.h"

#include <string>

namespace alvor {

/// Returns the mesh of a solve as its edits have made it. Throws RpcError, and Failure (usage) if `solve` is not the name of a
/// solve.
BaseMesh read_edited_mesh(Client& client, const std::string& solve);
/// The same, where the mesh of the scene as submitted is known.
BaseMesh read_edited_mesh(Client& client, const BaseMesh& submitted, const std::string& solve);

}  // namespace alvor
