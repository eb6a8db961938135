#include "client/command/commands/served_solution.h"

#include "client/command/commands/connection.h"
#include "client/command/commands/edited_scene.h"
#include "client/command/commands/solve_here.h"
#include "client/command/options/solve_name.h"
#include "client/command/output/display.h"
#include "client/command/output/failure.h"
#include "client/command/output/notes.h"
#include "client/command/output/numbers.h"
#include "client/export/glb_file.h"
#include "meshing/edit/present_scene.h"

#include <array>
#include <utility>

namespace alvor {

namespace {

/// A state of a solve, and the solve's record when the state was read.
struct State {
  v1::Solve solve;
  SolutionMirror mirror;
};

void require_published(const State& state, const std::string& solve) {
  if (!state.mirror.steps().empty()) return;
  const bool running = state.solve.state() == v1::Solve::RUNNING;
  throw Failure(ExitStatus::failed, solve + (running ? " has published nothing yet" : " has ended and published nothing"));
}

/// Throws Failure if nothing was published yet.
State newest_state(Client& client, const std::string& solve) {
  Client::Watch watch;
  std::stop_source enough;
  const auto stop_when_whole = [&](const Client::Watch& now) {
    if (now.mirror.whole() && !now.mirror.misses_errors()) enough.request_stop();
  };
  v1::Solve now = client.watch_solve(solve, watch, stop_when_whole, enough.get_token());
  State state{std::move(now), std::move(watch.mirror)};
  require_published(state, solve);
  return state;
}

/// Returns why a state is not within the tolerance of its solve, or does not heed all of its edits; nothing if it is and does.
/// `newest`: the solve after the state was read.
std::string unfinished(const State& state, const v1::Solve& newest) {
  const double error = state.mirror.steps().back().estimated_error;
  std::string reason = state.solve.state() == v1::Solve::SUCCEEDED
                           ? why_unfinished(state.solve.end_reason(), error)
                           : "the solve is " + v1::Solve::State_Name(state.solve.state()) +
                                 "; of its newest state the estimated error is " + percent(error);
  const std::uint64_t heeded = state.mirror.edits();
  const bool heeds_all = newest.edits().empty() || newest.edits().rbegin()->revision() <= heeded;
  if (!heeds_all)
    reason += (reason.empty() ? "" : "; ") + std::string("edits after revision ") + std::to_string(heeded) + " are not in it yet";
  return reason;
}

/// A state of a solve, and the scene with the edits that the state heeds.
struct StateOfScene {
  State state;
  EditedScene scene;
};

/// Returns the newest state. Reads it again where a slide of edits has gone on before its scene was read.
StateOfScene newest_of_scene(Client& client, const std::string& solve) {
  constexpr int most_attempts = 5;
  for (int attempt = 1;; ++attempt) {
    State state = newest_state(client, solve);
    try {
      EditedScene scene = read_edited(client, solve, edits_shown(state.mirror));
      return {std::move(state), std::move(scene)};
    } catch (const RpcError& error) {
      if (error.code != grpc::ABORTED) throw;
      if (attempt == most_attempts)
        throw Failure(ExitStatus::failed, solve + " is edited faster than it can be read: try again when the edits have ended");
    }
  }
}

/// Throws Failure if nothing is there to be shown.
void require_surfaces(const DisplayMesh& mesh, const std::string& solve) {
  if (mesh.triangles.empty())
    throw Failure(ExitStatus::bad_scene, solve + ": has no surface, or edits have taken all of it away");
}

// Returns the mesh to draw. Only in a solve that has succeeded does exactly dark mean hidden; before, light may not have arrived
// yet.
DisplayMesh mesh_of(const BaseMesh& base, const State& state, bool ambient) {
  if (!ambient) return solution_mesh(base, state.mirror.leaves(), state.mirror.errors());
  const Snapshot moment = snapshot_of(state.mirror);
  return state.solve.state() == v1::Solve::SUCCEEDED ? shown_mesh(base, moment, moment) : brightened_mesh(base, moment);
}

}  // namespace

DisplayMesh read_served_solution(const ServedSolution& source) {
  scene_name_of(source.solve);  // before a server is asked
  Connection connection(source.server);
  const State state = newest_state(connection.client(), source.solve);
  const BaseMesh base = read_edited_mesh(connection.client(), source.solve, edits_shown(state.mirror));
  const DisplayMesh mesh = mesh_of(base, state, source.ambient);
  require_surfaces(mesh, source.solve);
  return decode_glb(encode_glb(mesh));
}

ServedSolve read_served_solve(const ServerChoice& server, const std::string& solve) {
  const std::string scene_name = scene_name_of(solve);  // before a server is asked
  Connection connection(server);
  const auto [state, scene] = newest_of_scene(connection.client(), solve);
  ServedSolve served{present_scene(scene.scene), mesh_of(scene.mesh, state, false),
                     connection.client().get_scene(scene_name).display_name(),
                     unfinished(state, connection.client().get_solve(solve))};
  require_surfaces(served.mesh, solve);
  if (!served.unfinished.empty()) warn(std::array{served.unfinished});
  return served;
}

}  // namespace alvor
