#pragma once
// Moments at which a test may let the server die.

#include <csignal>
#include <cstdlib>
#include <string_view>

#include <unistd.h>

namespace alvor {

/// Kills the process at once, as kill -9 would, if the environment variable ALVOR_FAILPOINT is this name.
inline void failpoint(std::string_view name) {
  static const char* const chosen = std::getenv("ALVOR_FAILPOINT");
  if (chosen && name == chosen) kill(getpid(), SIGKILL);
}

}  // namespace alvor
