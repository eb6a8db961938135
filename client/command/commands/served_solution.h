#pragma once
// Reads the solution of a solve on a server, whether it runs or has ended.

#include "client/command/options/server_option.h"
#include "meshing/display_mesh.h"
#include "meshing/scene.h"

#include <string>

namespace alvor {

struct ServedSolution {
  ServerChoice server;
  std::string solve;     ///< scenes/SCENE/solves/SOLVE
  bool ambient = false;  ///< add the ambient term, only for display
};

/// Returns the newest complete state that the server has, as a solution file would hold it, so that both give the same picture.
/// Throws Failure if the name is malformed, the server cannot be reached, nothing was published yet, or nothing is there to be
/// seen (bad_scene); RpcError.
DisplayMesh read_served_solution(const ServedSolution& source);

/// A solve on a server: what is there of its scene, as edits have made it, and its newest complete state.
struct ServedSolve {
  Scene scene;  ///< see present_scene()
  DisplayMesh mesh;
  std::string scene_title;  ///< what who submitted the scene calls it, as a rule a file name; may be empty
  std::string unfinished;   ///< one sentence if the state is not within the tolerance or does not heed all edits, or empty
};

/// Returns a solve for commands that go on from it as from a scene that they have solved. Warns if it is unfinished. Throws as
/// read_served_solution(), and Failure (failed) if the solve is edited all the time.
ServedSolve read_served_solve(const ServerChoice& server, const std::string& solve);

}  // namespace alvor
