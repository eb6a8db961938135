#pragma once
// What a client asks of a solve, checked field by field.

#include "radiosity/solve/solver.h"
#include "server/archive/solve_record.h"

namespace alvor {

/// What this server grants a single solve.
struct SolveLimits {
  std::uint64_t leaves = 4'000'000;  ///< a leaf with its row takes one or two kilobytes
  int threads = 0;                   ///< 0: as many as the machine has
};

/// Fields left at 0 get the defaults of SolveOptions. Throws StatusError INVALID_ARGUMENT that names the field.
SolveOptions options_of(const SolveSpec& spec, const SolveLimits& limits);
/// Returns `spec` with the values of `options` for the fields that were left at their defaults, as Solve.effective_spec tells
/// them. Requires: options_of made `options` of `spec`.
SolveSpec effective_spec(SolveSpec spec, const SolveOptions& options);
/// Returns the priority that `spec` asks for; normal if it asks for none.
SolvePriority priority_of(const SolveSpec& spec);

}  // namespace alvor
