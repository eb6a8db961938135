#include "client/command/options/served_solve_option.h"

#include "client/command/options/solve_name.h"
#include "client/command/output/failure.h"

#include <filesystem>

namespace alvor {

void add_served_solve_option(CLI::App& command, ServerChoice& server, std::initializer_list<const char*> others) {
  CLI::Option& option =
      add_server_option(command, server, "Server of the solve; its newest state is taken, with the scene as edits have made it");
  const auto exclude = [&](std::initializer_list<const char*> names) {
    for (const char* name : names)
      if (CLI::Option* const other = command.get_option_no_throw(name)) option.excludes(other);
  };
  exclude({"--format", "--absorption", "--translucent", "--up", "--light-scale", "--quantity", "--luminaire",
           "--luminous-efficacy", "--sun", "--place", "--time", "--sun-light", "--sky", "--sky-light", "--ground", "--north",
           "--environment"});
  exclude(others);
}

void require_server(const ServerChoice& server, const std::string& file) {
  if (!server.is_given() && is_solve_name(file) && !std::filesystem::exists(file))
    throw Failure(ExitStatus::usage, file + " is the name of a solve: where is it? Add --server HOST:PORT");
}

}  // namespace alvor
