#include "server/solves/solve_spec.h"

#include "server/base/status_error.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <thread>

namespace alvor {

namespace {

template <class Value>
[[noreturn]] void refuse(const char* field, Value value, const std::string& reason) {
  throw invalid_field(std::string("solve.spec.") + field, value, reason);
}

int most_threads(const SolveLimits& limits) {
  const auto machine = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  return limits.threads > 0 ? std::min(limits.threads, machine) : machine;
}

}  // namespace

SolveOptions options_of(const SolveSpec& spec, const SolveLimits& limits) {
  SolveOptions options;
  if (spec.tolerance != 0 && !(spec.tolerance > 0 && spec.tolerance <= 1))
    refuse("tolerance", spec.tolerance, "is outside (0, 1]");
  if (spec.tolerance != 0) options.tolerance = spec.tolerance;
  if (spec.area_share != 0 && !(spec.area_share > 0 && spec.area_share <= 1))
    refuse("area_share", spec.area_share, "is outside (0, 1]");
  constexpr double share_of_objects = 0.95;
  constexpr std::size_t most_objects = 1000;
  options.objects = spec.objects;
  if (spec.objects.size() > most_objects) refuse("objects", spec.objects.size(), "are more than " + std::to_string(most_objects));
  if (!spec.objects.empty()) options.area_share = share_of_objects;
  if (spec.area_share != 0) options.area_share = spec.area_share;

  options.max_depth = spec.max_depth.value_or(options.max_depth);
  if (options.max_depth < 0 || options.max_depth > PatchId::max_level)
    refuse("max_depth", options.max_depth, "is outside [0, " + std::to_string(PatchId::max_level) + "]");

  options.max_leaves = spec.max_elements != 0 ? spec.max_elements : std::min(options.max_leaves, limits.leaves);
  if (options.max_leaves > limits.leaves)
    refuse("max_elements", options.max_leaves, "is more than " + std::to_string(limits.leaves) + ", the limit of this server");

  options.min_edge_m = spec.min_edge_m;
  if (!std::isfinite(options.min_edge_m) || options.min_edge_m < 0)
    refuse("min_edge_meters", options.min_edge_m, "is not a finite length >= 0");

  if (const double limit = spec.time_limit_s.value_or(0); limit > 0) options.time_limit_s = limit;
  options.step_pause_s = spec.step_pause_s.value_or(0);
  if (options.step_pause_s > 60) refuse("step_pause", options.step_pause_s, "s is more than a minute");

  options.threads = spec.threads == 0 ? most_threads(limits) : spec.threads;
  if (options.threads < 0 || options.threads > most_threads(limits))
    refuse("threads", options.threads, "is outside [0, " + std::to_string(most_threads(limits)) + "]");

  options.seed = spec.seed.value_or(options.seed);
  options.strategy = spec.strategy;
  options.form_factors = spec.form_factors;
  return options;
}

SolveSpec effective_spec(SolveSpec spec, const SolveOptions& options) {
  spec.tolerance = options.tolerance;
  spec.area_share = options.area_share;
  spec.max_depth = options.max_depth;
  spec.max_elements = options.max_leaves;
  spec.threads = options.threads;
  spec.seed = options.seed;
  if (spec.form_factors == FormFactorMethod::automatic) spec.form_factors = FormFactorMethod::nusselt;
  spec.priority = priority_of(spec);
  return spec;
}

SolvePriority priority_of(const SolveSpec& spec) { return spec.priority.value_or(SolvePriority::normal); }

}  // namespace alvor
