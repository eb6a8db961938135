#include "server/solves/solve_spec.h"

#include "proto/codec.h"
#include "server/base/status_error.h"

#include <cmath>
#include <cstdlib>
#include <sstream>
#include <thread>

namespace alvor {

namespace {

template <class Value>
[[noreturn]] void refuse(const char* field, Value value, const std::string& reason) {
  std::ostringstream text;
  text << "solve.spec." << field << ": " << value << " " << reason;
  throw invalid_argument(text.str());
}

int most_threads(const SolveLimits& limits) {
  const auto machine = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  return limits.threads > 0 ? std::min(limits.threads, machine) : machine;
}

double seconds_of(const google::protobuf::Duration& duration, const char* field) {
  const bool is_duration = std::abs(duration.nanos()) < 1'000'000'000 && duration.seconds() <= 315'576'000'000;
  const double seconds = decode_seconds(duration);
  if (!is_duration || seconds < 0) refuse(field, seconds, "s is not a duration >= 0");
  return seconds;
}

Strategy strategy_of(v1::Strategy strategy) {
  switch (strategy) {
    case v1::STRATEGY_UNSPECIFIED: return Strategy::automatic;
    case v1::STRATEGY_SORTED: return Strategy::sorted;
    case v1::STRATEGY_SORTED_AMBIENT: return Strategy::sorted_ambient;
    case v1::STRATEGY_GATHER: return Strategy::gather;
    case v1::STRATEGY_SHOOT: return Strategy::shoot;
    case v1::STRATEGY_OVERSHOOT: return Strategy::overshoot;
    default: refuse("strategy", static_cast<int>(strategy), "is not known to this server");
  }
}

FormFactorMethod form_factors_of(v1::FormFactors method) {
  switch (method) {
    case v1::FORM_FACTORS_UNSPECIFIED: return FormFactorMethod::automatic;
    case v1::FORM_FACTORS_NUSSELT: return FormFactorMethod::nusselt;
    case v1::FORM_FACTORS_HEMICUBE: return FormFactorMethod::hemicube;
    case v1::FORM_FACTORS_ANALYTIC: return FormFactorMethod::analytic;
    default: refuse("form_factors", static_cast<int>(method), "is not known to this server");
  }
}

}  // namespace

SolveOptions options_of(const v1::SolveSpec& spec, const SolveLimits& limits) {
  SolveOptions options;
  const double tolerance = spec.tolerance();
  if (tolerance != 0 && !(tolerance > 0 && tolerance <= 1)) refuse("tolerance", tolerance, "is outside (0, 1]");
  if (tolerance != 0) options.tolerance = tolerance;

  if (spec.has_max_depth()) options.max_depth = spec.max_depth();
  if (options.max_depth < 0 || options.max_depth > PatchId::max_level)
    refuse("max_depth", options.max_depth, "is outside [0, " + std::to_string(PatchId::max_level) + "]");

  if (spec.max_elements() != 0) options.max_leaves = spec.max_elements();
  else options.max_leaves = std::min(options.max_leaves, limits.leaves);
  if (options.max_leaves > limits.leaves)
    refuse("max_elements", options.max_leaves, "is more than " + std::to_string(limits.leaves) + ", the limit of this server");

  options.min_edge_m = spec.min_edge_meters();
  if (!std::isfinite(options.min_edge_m) || options.min_edge_m < 0)
    refuse("min_edge_meters", options.min_edge_m, "is not a finite length >= 0");

  if (const double limit = seconds_of(spec.time_limit(), "time_limit"); limit > 0) options.time_limit_s = limit;
  options.step_pause_s = seconds_of(spec.step_pause(), "step_pause");
  if (options.step_pause_s > 60) refuse("step_pause", options.step_pause_s, "s is more than a minute");

  options.threads = spec.threads() == 0 ? most_threads(limits) : spec.threads();
  if (options.threads < 0 || options.threads > most_threads(limits))
    refuse("threads", options.threads, "is outside [0, " + std::to_string(most_threads(limits)) + "]");

  if (spec.has_seed()) options.seed = spec.seed();
  if (!v1::Priority_IsValid(spec.priority())) refuse("priority", spec.priority(), "is not known to this server");
  options.strategy = strategy_of(spec.strategy());
  options.form_factors = form_factors_of(spec.form_factors());
  return options;
}

v1::SolveSpec effective_spec(v1::SolveSpec spec, const SolveOptions& options) {
  spec.set_tolerance(options.tolerance);
  spec.set_max_depth(options.max_depth);
  spec.set_max_elements(options.max_leaves);
  spec.set_threads(options.threads);
  spec.set_seed(options.seed);
  if (spec.form_factors() == v1::FORM_FACTORS_UNSPECIFIED) spec.set_form_factors(v1::FORM_FACTORS_NUSSELT);
  if (spec.priority() == v1::PRIORITY_UNSPECIFIED) spec.set_priority(v1::PRIORITY_NORMAL);
  return spec;
}

}  // namespace alvor
