#pragma once
// Runs the built commands as users do, for tests of exit statuses, streams and files.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include <sys/wait.h>
#include <unistd.h>

namespace alvor::test {

namespace fs = std::filesystem;

inline std::string text_of(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

inline long line_count(const std::string& text) { return std::ranges::count(text, '\n'); }

struct Ran {
  int status = -1;
  std::string out, err;
};

/// Expects that a run failed because of an input: status 3, and one line on stderr that names `file`.
inline void expect_bad_input(const Ran& ran, const std::string& file) {
  EXPECT_EQ(ran.status, 3);
  EXPECT_EQ(line_count(ran.err), 1) << ran.err;
  EXPECT_NE(ran.err.find(file), std::string::npos) << ran.err;
}

/// Makes a folder for each test and runs the command in it.
class CommandLine : public testing::Test {
 protected:
  CommandLine() : folder_(fs::temp_directory_path() / ("alvor_test_" + std::to_string(getpid()))) {
    fs::create_directories(folder_);
  }
  ~CommandLine() override { fs::remove_all(folder_); }

  Ran run(const std::string& arguments) const { return run_with("", arguments); }
  /// `launcher` begins the line: a program that runs the command, or an assignment of a variable.
  Ran run_with(const std::string& launcher, const std::string& arguments) const {
    const std::string line =
        "cd '" + folder_.string() + "' && " + launcher + " '" ALVOR_BINARIES "/alvor' " + arguments + " >out 2>err";
    const int ended = std::system(line.c_str());
    return {WIFEXITED(ended) ? WEXITSTATUS(ended) : -1, text_of(folder_ / "out"), text_of(folder_ / "err")};
  }
  fs::path file(const std::string& name) const { return folder_ / name; }
  void write(const std::string& name, const std::string& text) const { std::ofstream(file(name)) << text; }

 private:
  fs::path folder_;
};

}  // namespace alvor::test
