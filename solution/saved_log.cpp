// Saves a solution log as bytes and restores it. The bytes begin with a mark and a version. Version 3 does not tell errors of
// leaves nor Step::area_within, version 4 not Step::edits, version 5 has no slabs. Logs that were saved before there were
// versions begin with the number of their steps, which is never as large as the mark.

#include "solution/solution_log.h"

#include <algorithm>
#include <cmath>

namespace alvor {

namespace {

constexpr std::uint64_t mark = 0x676f'6c72'6f76'6c61;  // "alvorlog"
constexpr std::uint32_t newest_version = 6;
constexpr std::uint32_t oldest_marked = 3;
// Version 2 was written before marks were. Version 1, older still, does not have Step::unlit_fraction.
constexpr std::uint32_t unmarked_versions[] = {2, 1};
constexpr int farthest_scale = 200;

void check_tiling(std::span<const PatchId> patches) {
  for (std::size_t n = 0; n < patches.size(); ++n) {
    if (!patches[n].is_valid()) throw BadBytes("patch " + std::to_string(n) + ": is not one");
    if (n > 0 && patches[n].range_min() <= patches[n - 1].range_max()) throw BadBytes("patches: overlap");
    if (n > 0 && !patches[n - 1].agrees_on_splits(patches[n])) throw BadBytes("patches: do not agree on how patches are split");
  }
}

void check_revisions(std::span<const std::uint32_t> changed_at, std::uint64_t head) {
  if (std::ranges::any_of(changed_at, [&](std::uint32_t revision) { return revision == 0 || revision > head; }))
    throw BadBytes("revisions: beyond the newest");
}

void check_steps(std::span<const Step> steps) {
  for (std::size_t n = 0; n < steps.size(); ++n) {
    const Step& step = steps[n];
    const bool is_finite = std::isfinite(step.elapsed_s) && std::isfinite(step.unshot_fraction) &&
                           std::isfinite(step.estimated_error) && std::isfinite(step.displayed_error) &&
                           std::isfinite(step.unlit_fraction) && std::isfinite(step.area_within) &&
                           step.ambient_irradiance.is_finite();
    if (step.revision != n + 1 || step.step != n || !is_finite) throw BadBytes("step " + std::to_string(n) + ": cannot be");
  }
}

void put(const Rgb& value, PlainWriter& out) {
  out.put(value.r);
  out.put(value.g);
  out.put(value.b);
}

Rgb get_rgb(PlainReader& in) {
  Rgb value;
  value.r = in.get<double>();
  value.g = in.get<double>();
  value.b = in.get<double>();
  return value;
}

void put(const Step& step, PlainWriter& out) {
  out.put(step.revision);
  out.put(step.elapsed_s);
  out.put(step.step);
  out.put(step.shots);
  out.put(step.rays);
  out.put(step.leaves);
  out.put(step.unshot_fraction);
  out.put(step.estimated_error);
  out.put(step.displayed_error);
  out.put(step.unlit_fraction);
  out.put(step.area_within);
  out.put(step.edits);
  out.put(std::uint8_t{step.is_provisional});
  put(step.ambient_irradiance, out);
}

Step get_step(PlainReader& in, std::uint32_t version) {
  Step step;
  step.revision = in.get<std::uint64_t>();
  step.elapsed_s = in.get<double>();
  step.step = in.get<std::uint64_t>();
  step.shots = in.get<std::uint64_t>();
  step.rays = in.get<std::uint64_t>();
  step.leaves = in.get<std::uint64_t>();
  step.unshot_fraction = in.get<double>();
  step.estimated_error = in.get<double>();
  step.displayed_error = in.get<double>();
  if (version >= 2) step.unlit_fraction = in.get<double>();
  if (version >= 4) step.area_within = in.get<double>();
  if (version >= 5) {
    step.edits = in.get<std::uint64_t>();
    step.is_provisional = in.get<std::uint8_t>() != 0;
  }
  step.ambient_irradiance = get_rgb(in);
  return step;
}

/// Reads a count and as many steps. The count is not believed: memory grows only with the steps that are really there.
std::vector<Step> get_steps(PlainReader& in, std::uint32_t version) {
  std::vector<Step> steps;
  for (auto left = in.get<std::uint64_t>(); left > 0; --left) steps.push_back(get_step(in, version));
  check_steps(steps);
  return steps;
}

}  // namespace

void SolutionLog::save(PlainWriter& out) const {
  std::scoped_lock hold(lock_);
  out.put(mark);
  out.put(newest_version);
  out.put(std::uint64_t{steps_.size()});
  for (const Step& step : steps_) put(step, out);
  out.put(std::int32_t{coding_.scale()});
  out.put(std::uint8_t{has_coding_});
  out.put_all(leaves_.patch);
  out.put_all(leaves_.irradiance);
  out.put_all(leaves_.shown);
  out.put_all(leaves_.display.changed_at);
  out.put_all(leaves_.exact.changed_at);
  out.put_all(leaves_.error);
  out.put(std::int32_t{error_coding_.scale()});
  out.put(errors_revision_);
}

SolutionLog::SolutionLog(PlainReader& saved) {
  PlainReader marked = saved;
  if (marked.get<std::uint64_t>() != mark) {
    load_unmarked(saved);
    return;
  }
  const auto version = marked.get<std::uint32_t>();
  if (version < oldest_marked || version > newest_version) throw other_version(version, newest_version);
  load(marked, version);
  saved = marked;
}

/// Only one of the versions fits: read as another, the bytes do not make a tiling.
void SolutionLog::load_unmarked(PlainReader& saved) {
  std::string fault;
  for (const std::uint32_t version : unmarked_versions) {
    try {
      PlainReader in = saved;
      load(in, version);
      saved = in;
      return;
    } catch (const BadBytes& refusal) {
      if (fault.empty()) fault = refusal.what();
    }
  }
  throw BadBytes(fault);
}

void SolutionLog::load(PlainReader& saved, std::uint32_t version) {
  steps_ = get_steps(saved, version);
  head_ = steps_.size();
  const auto scale = saved.get<std::int32_t>();
  if (std::abs(std::int64_t{scale}) > farthest_scale) throw BadBytes("scale: cannot be");
  coding_ = SharedExponent(scale);
  has_coding_ = saved.get<std::uint8_t>() != 0;
  leaves_.patch = saved.get_all<PatchId>();
  const std::size_t count = leaves_.patch.size();
  leaves_.irradiance = saved.get_all<RgbF>(count, "irradiance");
  leaves_.shown = saved.get_all<std::uint32_t>(count, "displayed values");
  leaves_.display.changed_at = saved.get_all<Revision>(count, "revisions");
  leaves_.exact.changed_at = saved.get_all<Revision>(count, "revisions");
  if (version >= 4) load_errors(saved);
  else leaves_.error.assign(count, 0);
  check_tiling(leaves_.patch);
  check_revisions(leaves_.display.changed_at, head_);
  check_revisions(leaves_.exact.changed_at, head_);
  for (const RgbF& irradiance : leaves_.irradiance)
    if (!irradiance.is_finite() || irradiance.min() < 0) throw BadBytes("irradiance: is not a finite number >= 0");
  sum_up();
}

void SolutionLog::load_errors(PlainReader& saved) {
  leaves_.error = saved.get_all<std::uint8_t>(leaves_.patch.size(), "errors");
  const auto scale = saved.get<std::int32_t>();
  if (std::abs(std::int64_t{scale}) > ErrorCoding::farthest_scale) throw BadBytes("scale of errors: cannot be");
  error_coding_ = ErrorCoding(scale);
  errors_revision_ = saved.get<std::uint64_t>();
  if (errors_revision_ > head_) throw BadBytes("revision of errors: beyond the newest");
}

}  // namespace alvor
