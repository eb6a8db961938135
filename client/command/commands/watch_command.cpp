// alvor watch SOLVE: follows a solve that somebody started on a server. Ctrl-C ends the watch, not the solve.

#include "client/command/commands/commands.h"
#include "client/command/commands/connection.h"
#include "client/command/commands/edited_scene.h"
#include "client/command/commands/interrupt.h"
#include "client/command/commands/outputs.h"
#include "client/command/options/solve_name.h"
#include "client/command/output/failure.h"
#include "client/command/output/notes.h"

#include <memory>
#include <optional>

namespace alvor {

namespace {

struct WatchCommand {
  std::string solve;
  ServerChoice server;
  OutputOptions outputs;
};

/// The result of a watch, and the mesh of the solve with its edits.
struct Watched {
  std::optional<BaseMesh> mesh;
  std::vector<std::string> warnings;
  Followed followed;
};

Watched join_and_follow(const WatchCommand& command, const std::string& scene_name) {
  Interrupt interrupt;
  Connection connection(command.server);
  Client& client = connection.client();
  const FollowOptions options{std::chrono::steady_clock::now(), !command.outputs.frames.empty()};
  const v1::Scene scene = client.get_scene(scene_name);
  Watched watched{{}, {scene.warnings().begin(), scene.warnings().end()}, {}};
  warn(watched.warnings);
  watched.followed = follow(client, client.get_solve(command.solve), options, interrupt.token());
  watched.mesh = read_edited_mesh(client, command.solve, edits_shown(watched.followed.mirror));
  return watched;
}

void run_watch(const WatchCommand& command) {
  const std::string scene_name = scene_name_of(command.solve);
  prepare_outputs(command.outputs);
  const Watched watched = join_and_follow(command, scene_name);
  deliver(command.outputs, *watched.mesh, watched.followed, watched.warnings);
}

}  // namespace

void add_watch_command(CLI::App& app) {
  const auto options = std::make_shared<WatchCommand>();
  CLI::App& command = *app.add_subcommand("watch", "Follow a solve on a server");
  command.add_option("solve", options->solve, "Name of the solve: scenes/SCENE/solves/SOLVE")->required()->type_name("SOLVE");
  add_server_option(command, options->server, "Server that runs the solve").required();
  add_output_options(command, options->outputs);
  command.callback([options] { run_watch(*options); });
}

}  // namespace alvor
