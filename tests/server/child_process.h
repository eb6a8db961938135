#pragma once
// Runs a program in a process of its own.

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

extern char** environ;

namespace alvor {

/// A child process, killed on destruction if it still runs.
class ChildProcess {
 public:
  /// Runs the first of `words` with the others as arguments, and with `variable` (NAME=VALUE) in its environment. Its output to
  /// `stream` can be read line by line. Throws std::system_error.
  ChildProcess(std::vector<std::string> words, int stream, std::string variable = "ALVOR_TEST=1") {
    int ends[2] = {-1, -1};
    if (pipe2(ends, O_CLOEXEC) != 0) throw std::system_error(errno, std::generic_category(), "pipe");
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[1], stream);
    std::vector<char*> argv, environment;
    for (std::string& word : words) argv.push_back(word.data());
    for (char** entry = environ; *entry; ++entry) environment.push_back(*entry);
    environment.push_back(variable.data());
    argv.push_back(nullptr);
    environment.push_back(nullptr);
    const int failed = posix_spawn(&process_, argv[0], &actions, nullptr, argv.data(), environment.data());
    posix_spawn_file_actions_destroy(&actions);
    close(ends[1]);
    output_ = fdopen(ends[0], "r");
    if (failed != 0) throw std::system_error(failed, std::generic_category(), words[0]);
  }
  ~ChildProcess() {
    if (process_ > 0) kill();
    std::fclose(output_);
  }
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// Returns the next line of its output with the newline; "" after the last.
  std::string line() {
    char text[4096] = "";
    return std::fgets(text, sizeof text, output_) ? text : "";
  }
  pid_t process() const { return process_; }
  void signal(int number) { ::kill(process_, number); }
  /// Kills the process without warning, as a power failure would.
  void kill() {
    signal(SIGKILL);
    exit_status();
  }
  int exit_status() {
    int status = 0;
    waitpid(std::exchange(process_, -1), &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

 private:
  pid_t process_ = -1;
  std::FILE* output_ = nullptr;
};

}  // namespace alvor
