#pragma once
// How long a run of the server lasted, so that the next one can tell how much work was lost.

#include <chrono>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

namespace alvor {

/// Returns the time since any fixed moment. Unlike the time of day it never jumps.
using RunClock = std::function<std::chrono::microseconds()>;
std::chrono::microseconds steady_time();

/// A moment in a run of the server.
struct RunMoment {
  std::string run;  ///< a random name
  std::chrono::microseconds age;
};

/// A file that holds the newest moment of a run. Nothing here throws.
class AliveFile {
 public:
  explicit AliveFile(std::filesystem::path file) : file_(std::move(file)) {}
  /// Returns nothing where there is no file, or one that another version or a power cut left.
  std::optional<RunMoment> read() const;
  /// Written over what is there, so that a full disk does not hinder it.
  void write(const RunMoment& moment) const;

 private:
  const std::filesystem::path file_;
};

}  // namespace alvor
