#include "client/command/commands/served_solution.h"

#include "client/command/commands/connection.h"
#include "client/command/commands/edited_mesh.h"
#include "client/command/options/solve_name.h"
#include "client/command/output/display.h"
#include "client/command/output/failure.h"
#include "client/export/glb_file.h"

#include <utility>

namespace alvor {

namespace {

/// A state of a solve, and the solve's record when the state was read.
struct State {
  v1::Solve solve;
  SolutionMirror mirror;
};

State newest_state(Client& client, const std::string& solve) {
  Client::Watch watch;
  std::stop_source enough;
  const auto stop_when_whole = [&](const Client::Watch& now) {
    if (now.mirror.whole() && !now.mirror.misses_errors()) enough.request_stop();
  };
  v1::Solve now = client.watch_solve(solve, watch, stop_when_whole, enough.get_token());
  return {std::move(now), std::move(watch.mirror)};
}

void require_published(const State& state, const std::string& solve) {
  if (!state.mirror.steps().empty()) return;
  const bool running = state.solve.state() == v1::Solve::RUNNING;
  throw Failure(ExitStatus::failed, solve + (running ? " has published nothing yet" : " has ended and published nothing"));
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
  require_published(state, source.solve);
  const BaseMesh base = read_edited_mesh(connection.client(), source.solve, edits_shown(state.mirror));
  return decode_glb(encode_glb(mesh_of(base, state, source.ambient)));
}

}  // namespace alvor
