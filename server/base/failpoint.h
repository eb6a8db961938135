#pragma once
// Points in the code at which a test can make the server die.

#include <csignal>
#include <cstdlib>
#include <string_view>

#include <unistd.h>

namespace alvor {

/// Kills the process at once, like kill -9, if the environment variable ALVOR_FAILPOINT is `name`.
inline void failpoint(std::string_view name) {
  static const char* const chosen = std::getenv("ALVOR_FAILPOINT");
  if (chosen && name == chosen) kill(getpid(), SIGKILL);
}

}  // namespace alvor
