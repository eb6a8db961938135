#pragma once
// What must hold of every solution.

#include "tests/random/trial.h"

#include <optional>
#include <string>
#include <string_view>

namespace alvor::test {

struct Breach {
  std::string_view invariant;
  std::string how;
  bool by_clock = false;  ///< another time it may not fail
};

/// The first invariant that the trial breaks. `only`: looks at the one of this name, and at what it needs.
std::optional<Breach> find_breach(const Trial& trial, std::string_view only = {});

}  // namespace alvor::test
