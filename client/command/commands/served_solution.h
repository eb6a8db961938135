#pragma once
// The solution of a solve on a server, running or ended.

#include "client/command/options/server_option.h"
#include "meshing/display_mesh.h"

#include <string>

namespace alvor {

struct ServedSolution {
  ServerChoice server;
  std::string solve;     ///< scenes/SCENE/solves/SOLVE
  bool ambient = false;  ///< add the ambient term: for display only
};

/// The newest whole state that the server has, as a solution file would hold it, so that both give the same picture. Throws
/// Failure if the name is none, the server cannot be reached or nothing was published; RpcError.
DisplayMesh read_served_solution(const ServedSolution& source);

}  // namespace alvor
