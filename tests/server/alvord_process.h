#pragma once
// The alvord program as a process of its own.

#include <gtest/gtest.h>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>
#include <csignal>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

extern char** environ;

namespace alvor {

/// A running alvord; what it logs can be read line by line.
class Alvord {
 public:
  explicit Alvord(std::vector<std::string> arguments, const std::string& variable = "ALVOR_TEST=1") {
    arguments.insert(arguments.begin(), ALVOR_BINARIES "/alvord");
    std::vector<char*> argv;
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    int ends[2] = {-1, -1};
    EXPECT_EQ(pipe2(ends, O_CLOEXEC), 0);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[1], STDERR_FILENO);
    std::vector<char*> environment;
    for (char** entry = environ; *entry; ++entry) environment.push_back(*entry);
    std::string own = variable;
    environment.push_back(own.data());
    environment.push_back(nullptr);
    EXPECT_EQ(posix_spawn(&process_, argv[0], &actions, nullptr, argv.data(), environment.data()), 0);
    posix_spawn_file_actions_destroy(&actions);
    close(ends[1]);
    log_ = fdopen(ends[0], "r");
  }
  ~Alvord() {
    if (process_ > 0) kill();
    std::fclose(log_);
  }
  Alvord(const Alvord&) = delete;
  Alvord& operator=(const Alvord&) = delete;

  /// The next line of the log, "" at its end.
  std::string line() {
    char text[4096] = "";
    return std::fgets(text, sizeof text, log_) ? text : "";
  }
  /// Reads the log up to the line that tells the address.
  std::string address() {
    const std::string words = "listening on ";
    for (std::string next = line(); !next.empty(); next = line())
      if (const auto at = next.find(words); at != std::string::npos) {
        next.pop_back();  // the line's end
        return next.substr(at + words.size());
      }
    return "";
  }
  pid_t process() const { return process_; }
  void ask_to_stop() { ::kill(process_, SIGTERM); }
  /// As when the power fails.
  void kill() {
    ::kill(process_, SIGKILL);
    exit_status();
  }
  int exit_status() {
    int status = 0;
    waitpid(std::exchange(process_, -1), &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

 private:
  pid_t process_ = -1;
  std::FILE* log_ = nullptr;
};

}  // namespace alvor
