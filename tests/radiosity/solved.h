#pragma once
// Solves a scene without a server, for tests that look at its leaves.

#include "radiosity/solve/solver.h"
#include "solution/solution_log.h"

#include <vector>

namespace alvor::test {

/// Returns the leaves of the whole solution.
inline std::vector<LeafValue> solved(const BaseMesh& mesh, const SolveOptions& options) {
  SolutionLog log;
  solve(mesh, options, log, {});
  return log.leaves();
}

}  // namespace alvor::test
