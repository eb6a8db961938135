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
#include "meshing/present_objects.h"

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

/// Returns why a state is not within the tolerance of its solve; nothing if it is.
std::string unfinished(const State& state) {
  const double error = state.mirror.steps().back().estimated_error;
  if (state.solve.state() == v1::Solve::SUCCEEDED) return why_unfinished(state.solve.end_reason(), error);
  return "the solve is " + v1::Solve::State_Name(state.solve.state()) + "; of its newest state the estimated error is " +
         percent(error);
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
  const BaseMesh base = read_edited(connection.client(), source.solve, edits_shown(state.mirror)).mesh;
  return decode_glb(encode_glb(mesh_of(base, state, source.ambient)));
}

ServedSolve read_served_solve(const ServerChoice& server, const std::string& solve) {
  scene_name_of(solve);  // before a server is asked
  Connection connection(server);
  const State state = newest_state(connection.client(), solve);
  const EditedScene edited = read_edited(connection.client(), solve, edits_shown(state.mirror));
  ServedSolve served{present_scene(edited.scene), mesh_of(edited.mesh, state, false), unfinished(state)};
  if (served.scene.faces.empty()) throw Failure(ExitStatus::bad_scene, solve + ": edits have taken all objects away");
  if (!served.unfinished.empty()) warn(std::array{served.unfinished});
  return served;
}

}  // namespace alvor
