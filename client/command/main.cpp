// The command `alvor`.

#include "client/command/commands.h"
#include "client/command/failure.h"
#include "client/scene_file.h"
#include "client/solution_file.h"

#include <google/protobuf/stubs/common.h>

#include <algorithm>
#include <cstdlib>
#include <iostream>

namespace alvor {

namespace {

// stderr carries only our own lines. GRPC_VERBOSITY in the environment still works for those who look for a fault.
void silence_libraries() {
  setenv("GRPC_VERBOSITY", "NONE", 0);
  google::protobuf::SetLogHandler(nullptr);
}

void add_commands(CLI::App& app) {
  app.set_version_flag("--version", "alvor " ALVOR_VERSION);
  app.require_subcommand(1);
  add_solve_command(app);
  add_watch_command(app);
  add_probe_command(app);
  add_render_command(app);
  add_verify_command(app);
  add_compare_command(app);
  add_explain_command(app);
  add_form_factor_command(app);
  add_form_factors_command(app);
  add_scenes_command(app);
  add_solves_command(app);
}

ExitStatus say(ExitStatus status, std::string line) {
  std::ranges::replace(line, '\n', ' ');
  std::cerr << "alvor: " << line << '\n';
  return status;
}

ExitStatus say_usage(const CLI::App& app, const CLI::ParseError& error) {
  if (error.get_exit_code() != 0) return say(ExitStatus::usage, std::string(error.what()) + " (see --help)");
  app.exit(error);  // prints the help or the version that was asked for
  return ExitStatus::done;
}

ExitStatus run(int argc, char** argv) {
  CLI::App app("Radiosity of diffuse scenes, meshed where the light changes", "alvor");
  try {
    add_commands(app);
    app.parse(argc, argv);
    return ExitStatus::done;
  } catch (const CLI::ParseError& error) {
    return say_usage(app, error);
  } catch (const Failure& failure) {
    return say(failure.status, failure.what());
  } catch (const RpcError& error) {
    return say(failure_of(error).status, failure_of(error).what());
  } catch (const SceneFileError& error) {
    return say(ExitStatus::bad_scene, error.what());
  } catch (const std::exception& error) {
    return say(ExitStatus::failed, error.what());
  }
}

}  // namespace

}  // namespace alvor

int main(int argc, char** argv) {
  alvor::silence_libraries();
  return static_cast<int>(alvor::run(argc, argv));
}
