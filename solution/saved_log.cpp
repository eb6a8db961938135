// Saves a solution log as bytes and restores it.

#include "solution/solution_log.h"

#include <algorithm>
#include <cmath>

namespace alvor {

namespace {

constexpr int farthest_scale = 200;

void check_tiling(std::span<const PatchId> patches) {
  for (std::size_t n = 0; n < patches.size(); ++n) {
    if (!patches[n].is_valid()) throw BadBytes("patch " + std::to_string(n) + ": is not one");
    if (n > 0 && patches[n].range_min() <= patches[n - 1].range_max()) throw BadBytes("patches: overlap");
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
                           std::isfinite(step.unlit_fraction) && step.ambient_irradiance.is_finite();
    if (step.revision != n + 1 || step.step != n || !is_finite) throw BadBytes("step " + std::to_string(n) + ": cannot be");
  }
}

}  // namespace

void SolutionLog::save(PlainWriter& out) const {
  std::scoped_lock hold(lock_);
  out.put_all(steps_);
  out.put(coding_.scale());
  out.put(has_coding_);
  out.put_all(leaves_.patch);
  out.put_all(leaves_.irradiance);
  out.put_all(leaves_.shown);
  out.put_all(leaves_.display.changed_at);
  out.put_all(leaves_.exact.changed_at);
}

SolutionLog::SolutionLog(PlainReader& saved) {
  steps_ = saved.get_all<Step>();
  check_steps(steps_);
  head_ = steps_.size();
  const int scale = saved.get<int>();
  if (std::abs(scale) > farthest_scale) throw BadBytes("scale: cannot be");
  coding_ = SharedExponent(scale);
  has_coding_ = saved.get<std::uint8_t>() != 0;
  leaves_.patch = saved.get_all<PatchId>();
  const std::size_t count = leaves_.patch.size();
  leaves_.irradiance = saved.get_all<RgbF>(count, "irradiance");
  leaves_.shown = saved.get_all<std::uint32_t>(count, "displayed values");
  leaves_.display.changed_at = saved.get_all<Revision>(count, "revisions");
  leaves_.exact.changed_at = saved.get_all<Revision>(count, "revisions");
  check_tiling(leaves_.patch);
  check_revisions(leaves_.display.changed_at, head_);
  check_revisions(leaves_.exact.changed_at, head_);
  for (const RgbF& irradiance : leaves_.irradiance)
    if (!irradiance.is_finite() || irradiance.min() < 0) throw BadBytes("irradiance: is not a finite number >= 0");
  sum_up();
}

}  // namespace alvor
