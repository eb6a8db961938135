// alvor scenes and alvor solves: list, show and change the scenes and solves of a server.

#include "client/command/commands/commands.h"
#include "client/command/commands/connection.h"
#include "client/command/commands/interrupt.h"
#include "client/command/output/notes.h"
#include "client/command/output/numbers.h"
#include "client/command/output/plan_text.h"
#include "client/command/output/table.h"
#include "proto/codec.h"

#include <google/protobuf/util/time_util.h>
#include <nlohmann/json.hpp>

#include <unistd.h>
#include <chrono>
#include <iostream>
#include <memory>
#include <thread>

namespace alvor {

namespace {

using Json = nlohmann::ordered_json;
using google::protobuf::util::TimeUtil;

struct ListOptions {
  ServerChoice server;
  std::string parent = "scenes/-";  ///< parent of the solves; "-": all scenes
  bool json = false;
  bool watch = false;
};

struct GetOptions {
  ServerChoice server;
  std::string name;
  bool json = false;
};

struct NameOptions {
  ServerChoice server;
  std::vector<std::string> names;
};

Json json_of(const v1::Scene& scene) {
  return {{"name", scene.name()},
          {"display_name", scene.display_name()},
          {"create_time", TimeUtil::ToString(scene.create_time())},
          {"vertex_count", scene.vertex_count()},
          {"face_count", scene.face_count()},
          {"material_count", scene.material_count()},
          {"object_count", scene.object_count()},
          {"light_count", scene.light_count()},
          {"quantity", v1::Quantity_Name(scene.quantity())},
          {"warnings", std::vector<std::string>(scene.warnings().begin(), scene.warnings().end())}};
}

Json json_of(const v1::Solve& solve) {
  const Step step = decode(solve.last_step());
  return {{"name", solve.name()},
          {"state", v1::Solve::State_Name(solve.state())},
          {"end_reason", solve.end_reason()},
          {"create_time", TimeUtil::ToString(solve.create_time())},
          {"elapsed_s", step.elapsed_s},
          {"shots", step.shots},
          {"rays", step.rays},
          {"leaves", step.leaves},
          {"unshot_fraction", step.unshot_fraction},
          {"estimated_error", step.estimated_error},
          {"edits", step.edits},
          {"restarts", solve.restarts()},
          {"resumed_from_revision", solve.resumed_from_revision()},
          {"work_lost_s", decode_seconds(solve.work_lost())},
          {"plan", json_of(decode(solve.plan()))}};
}

using Row = std::vector<std::string>;

Row header_of(const v1::Scene&) { return {"NAME", "CREATED", "FACES", "VERTICES", "DISPLAY NAME"}; }
Row row_of(const v1::Scene& scene) {
  return {scene.name(), TimeUtil::ToString(scene.create_time()), std::to_string(scene.face_count()),
          std::to_string(scene.vertex_count()), scene.display_name()};
}

Row header_of(const v1::Solve&) { return {"NAME", "CREATED", "STATE", "LEAVES", "ERROR", "ENDED BY"}; }
Row row_of(const v1::Solve& solve) {
  const v1::Step& step = solve.last_step();
  return {solve.name(),
          TimeUtil::ToString(solve.create_time()),
          v1::Solve::State_Name(solve.state()),
          std::to_string(step.leaves()),
          solve.has_last_step() ? percent(step.estimated_error()) : "-",
          solve.end_reason()};
}

template <class Resource>
void print_table(const std::vector<Resource>& resources) {
  std::vector<Row> rows{header_of(Resource())};
  for (const Resource& resource : resources) rows.push_back(row_of(resource));
  std::cout << aligned(rows);
}

template <class Resource>
void print_json(const std::vector<Resource>& resources) {
  Json array = Json::array();
  for (const Resource& resource : resources) array.push_back(json_of(resource));
  std::cout << array.dump(2, ' ', false, Json::error_handler_t::replace) << '\n';
}

template <class Resource>
void print(const std::vector<Resource>& resources, const ListOptions& options) {
  options.json ? print_json(resources) : print_table(resources);
}

void require_server(CLI::App& command, ServerChoice& server) {
  add_server_option(command, server, "The server that holds them").required();
}

/// Prints the list every second until Ctrl-C; clears a terminal before each.
template <class List>
void watch(Client& client, List list, const ListOptions& options) {
  Interrupt interrupt;
  const std::stop_token stop = interrupt.token();
  while (!stop.stop_requested()) {
    const auto resources = list(client, options);
    if (isatty(STDOUT_FILENO)) std::cout << "\033[H\033[2J";
    print(resources, options);
    require_stdout_taken();
    for (int tenth = 0; tenth < 10 && !stop.stop_requested(); ++tenth)
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
}

/// Adds the subcommand `list`. `list` is called with the client and the options.
template <class List>
CLI::App& add_list(CLI::App& parent, const std::shared_ptr<ListOptions>& options, List list) {
  CLI::App& command = *parent.add_subcommand("list", "Print a list, newest first");
  require_server(command, options->server);
  command.add_flag("--json", options->json, "Print a JSON array");
  command.callback([options, list] {
    Connection connection(options->server);
    if (options->watch) return watch(connection.client(), list, *options);
    print(list(connection.client(), *options), *options);
  });
  return command;
}

/// Prints a solve and its plan.
void print_solve(const v1::Solve& solve, bool json) {
  if (json) {
    std::cout << json_of(solve).dump(2, ' ', false, Json::error_handler_t::replace) << '\n';
    return;
  }
  print_table(std::vector{solve});
  if (solve.has_plan()) std::cout << '\n' << table_of(decode(solve.plan()));
}

void add_get(CLI::App& solves) {
  const auto options = std::make_shared<GetOptions>();
  CLI::App& command = *solves.add_subcommand("get", "Show one solve, and which solver features its scene needs");
  require_server(command, options->server);
  command.add_option("name", options->name, "Name as list prints it")->required()->type_name("NAME");
  command.add_flag("--json", options->json, "Print a JSON object");
  command.callback([options] {
    Connection connection(options->server);
    print_solve(connection.client().get_solve(options->name), options->json);
  });
}

/// Adds a subcommand that calls `act` with the client and each name.
template <class Act>
void add_act(CLI::App& parent, const std::string& verb, const std::string& description, Act act) {
  const auto options = std::make_shared<NameOptions>();
  CLI::App& command = *parent.add_subcommand(verb, description);
  require_server(command, options->server);
  command.add_option("names", options->names, "Names as list prints them")->required()->type_name("NAME");
  command.callback([options, act] {
    Connection connection(options->server);
    for (const std::string& name : options->names) act(connection.client(), name);
  });
}

}  // namespace

void add_scenes_command(CLI::App& app) {
  CLI::App& scenes = *app.add_subcommand("scenes", "List or delete the scenes of a server")->require_subcommand(1);
  add_list(scenes, std::make_shared<ListOptions>(), [](Client& client, const ListOptions&) { return client.list_scenes(); });
  add_act(scenes, "delete", "Delete scenes without solves",
          [](Client& client, const std::string& name) { client.delete_scene(name); });
}

void add_solves_command(CLI::App& app) {
  CLI::App& solves =
      *app.add_subcommand("solves", "List, show, cancel, pause, resume or delete the solves of a server")->require_subcommand(1);
  const auto options = std::make_shared<ListOptions>();
  CLI::App& list =
      add_list(solves, options, [](Client& client, const ListOptions& asked) { return client.list_solves(asked.parent); });
  list.add_option("scene", options->parent, "Only the solves of this scene")->type_name("SCENE");
  list.add_flag("--watch", options->watch, "Print the list every second until Ctrl-C");
  add_get(solves);
  add_act(solves, "cancel", "Stop solves; their solutions so far are kept",
          [](Client& client, const std::string& name) { client.cancel_solve(name); });
  add_act(solves, "pause", "Make solves release their threads and memory until they are resumed",
          [](Client& client, const std::string& name) { client.pause_solve(name); });
  add_act(solves, "resume", "Continue paused solves", [](Client& client, const std::string& name) { client.resume_solve(name); });
  add_act(solves, "delete", "Delete solves that have ended",
          [](Client& client, const std::string& name) { client.delete_solve(name); });
}

}  // namespace alvor
