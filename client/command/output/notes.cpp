#include "client/command/output/notes.h"

#include "client/command/output/failure.h"

#include <cerrno>
#include <cstring>
#include <iostream>

namespace alvor {

namespace {

// State of the process, like its streams; set while the command line is parsed, before any thread starts.
bool is_quiet = false;
bool stdout_is_reserved = false;

std::ostream& nowhere() {
  static std::ostream stream(nullptr);
  return stream;
}

}  // namespace

void add_quiet_option(CLI::App& command) {
  command.add_flag_callback(
      "-q,--quiet", [] { is_quiet = true; }, "Print no progress and no remarks, only results, warnings and errors");
  for (CLI::App* subcommand : command.get_subcommands([](CLI::App*) { return true; })) add_quiet_option(*subcommand);
}

void reserve_stdout() { stdout_is_reserved = true; }

std::ostream& results() { return stdout_is_reserved ? std::cerr : std::cout; }

std::ostream& notes() { return is_quiet ? nowhere() : results(); }

std::ostream& progress() { return is_quiet ? nowhere() : std::cerr; }

void warn(std::span<const std::string> warnings) {
  for (const std::string& warning : warnings) std::cerr << "warning: " << warning << '\n';
}

void require_stdout_taken() {
  errno = 0;
  std::cout.flush();
  if (std::cout) return;
  throw Failure(ExitStatus::bad_scene, std::string("stdout: cannot be written: ") + std::strerror(errno ? errno : EPIPE));
}

}  // namespace alvor
