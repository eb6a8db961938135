#pragma once
// Invariants that every solution must satisfy.

#include "tests/random/trial.h"

#include <optional>
#include <string>
#include <string_view>

namespace alvor::test {

struct Breach {
  std::string_view invariant;
  std::string how;
  bool by_clock = false;  ///< the clock was involved, so a repetition may not fail
};

/// Returns the first invariant that the trial breaks. If `only` is given, checks only that one and those that it needs.
std::optional<Breach> find_breach(const Trial& trial, std::string_view only = {});

}  // namespace alvor::test
