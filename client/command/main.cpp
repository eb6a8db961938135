// The main program of the command `alvor`.

#include "client/command/commands/commands.h"
#include "client/command/options/usage_message.h"
#include "client/command/output/failure.h"
#include "client/command/output/notes.h"
#include "client/export/solution_file.h"
#include "client/rpc/in_process.h"
#include "import/apart/scene_file.h"
#include "meshing/base_mesh.h"

#include <google/protobuf/stubs/common.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <iostream>

namespace alvor {

namespace {

// Ignores SIGPIPE: when the reader of our output closes the pipe, as `head` does, writing returns an error.
void outlive_closed_pipes() { std::signal(SIGPIPE, SIG_IGN); }

// Silences gRPC and protobuf, so that stderr carries only our own lines. GRPC_VERBOSITY in the environment still works for
// debugging.
void silence_libraries() {
  setenv("GRPC_VERBOSITY", "NONE", 0);
  google::protobuf::SetLogHandler(nullptr);
}

void add_commands(CLI::App& app) {
  app.set_version_flag("--version", "alvor " ALVOR_VERSION);
  app.require_subcommand(1);
  add_solve_command(app);
  add_watch_command(app);
  add_edit_command(app);
  add_probe_command(app);
  add_render_command(app);
  add_verify_command(app);
  add_bake_command(app);
  add_report_command(app);
  add_compare_command(app);
  add_explain_command(app);
  add_form_factor_command(app);
  add_form_factors_command(app);
  add_luminaire_command(app);
  add_scenes_command(app);
  add_solves_command(app);
  add_quiet_option(app);
  app.failure_message(usage_message);
}

ExitStatus say(ExitStatus status, std::string line) {
  std::ranges::replace(line, '\n', ' ');
  std::cerr << "alvor: " << line << '\n';
  return status;
}

/// Runs the chosen command, or prints the help, the version, or the fault of the command line.
ExitStatus parse_and_run(CLI::App& app, int argc, char** argv) {
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (app.exit(error) != 0) return ExitStatus::usage;
  }
  require_stdout_taken();
  return ExitStatus::done;
}

ExitStatus run(int argc, char** argv) {
  CLI::App app("Radiosity of diffuse scenes, meshed where the light changes", "alvor");
  try {
    ProgramRanks ranks;
    if (!ranks.is_first()) {
      ranks.follow();
      return ExitStatus::done;
    }
    add_commands(app);
    return parse_and_run(app, argc, argv);
  } catch (const Failure& failure) {
    return say(failure.status, failure.what());
  } catch (const RpcError& error) {
    return say(failure_of(error).status, failure_of(error).what());
  } catch (const SceneFileError& error) {
    return say(ExitStatus::bad_scene, error.what());
  } catch (const TooManyRoots& error) {
    return say(ExitStatus::bad_scene, error.what());
  } catch (const std::exception& error) {
    return say(ExitStatus::failed, error.what());
  }
}

}  // namespace

}  // namespace alvor

int main(int argc, char** argv) {
  alvor::outlive_closed_pipes();
  alvor::silence_libraries();
  return static_cast<int>(alvor::run(argc, argv));
}
