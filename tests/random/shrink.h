#pragma once

#include "tests/random/trial.h"

#include <functional>

namespace alvor::test {

/// The same failure in less: faces and vertices left out, plain materials, round coordinates, default options, as long as
/// `fails`; what a minute gives. Requires: fails(trial).
Trial shrunk(Trial trial, const std::function<bool(const Trial&)>& fails);

}  // namespace alvor::test
