#pragma once
// Runs the alvord program in a process of its own.

#include "tests/server/child_process.h"

namespace alvor {

/// A running alvord; its log can be read line by line.
class Alvord : public ChildProcess {
 public:
  explicit Alvord(std::vector<std::string> arguments, const std::string& variable = "ALVOR_TEST=1")
      : ChildProcess(command(std::move(arguments)), STDERR_FILENO, variable) {}

  /// Reads the log up to the line with `words`, and returns the address that follows them.
  std::string address(const std::string& words = "listening on ") {
    for (std::string next = line(); !next.empty(); next = line())
      if (const auto at = next.find(words); at != std::string::npos) {
        next.pop_back();  // the newline
        return next.substr(at + words.size());
      }
    return "";
  }
  void ask_to_stop() { signal(SIGTERM); }

 private:
  static std::vector<std::string> command(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), ALVOR_BINARIES "/alvord");
    return arguments;
  }
};

}  // namespace alvor
