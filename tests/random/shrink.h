#pragma once

#include "tests/random/trial.h"

#include <functional>

namespace alvor::test {

/// Returns a smaller trial that still fails: with faces and vertices left out, plain materials, round coordinates and default
/// options. Tries for a minute. Requires: fails(trial).
Trial shrunk(Trial trial, const std::function<bool(const Trial&)>& fails);

}  // namespace alvor::test
