#pragma once
// Reads the solution of a solve on a server, whether it runs or has ended.

#include "client/command/options/server_option.h"
#include "meshing/display_mesh.h"

#include <string>

namespace alvor {

struct ServedSolution {
  ServerChoice server;
  std::string solve;     ///< scenes/SCENE/solves/SOLVE
  bool ambient = false;  ///< add the ambient term, only for display
};

/// Returns the newest complete state that the server has, as a solution file would hold it, so that both give the same picture.
/// Throws Failure if the name is malformed, the server cannot be reached or nothing was published yet; RpcError.
DisplayMesh read_served_solution(const ServedSolution& source);

}  // namespace alvor
