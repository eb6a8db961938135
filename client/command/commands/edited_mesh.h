#pragma once

#include "client/rpc/client.h"
#include "meshing/base_mesh.h"

#include <string>

namespace alvor {

/// Returns the mesh of a solve as its edits have made it. Throws RpcError, and Failure (usage) if `solve` is not the name of a
/// solve.
BaseMesh read_edited_mesh(Client& client, const std::string& solve);
/// Returns that mesh without reading the scene as submitted, whose mesh is `submitted`. Throws as above.
BaseMesh read_edited_mesh(Client& client, const BaseMesh& submitted, const std::string& solve);

}  // namespace alvor
