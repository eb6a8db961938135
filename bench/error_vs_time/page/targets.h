#pragma once
// The targets for Alvor's speed and accuracy, and whether they are met.

#include "bench/error_vs_time/contest/contest.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace alvor::bench {

enum class Verdict { met, missed, not_measured };
std::string_view text(Verdict verdict);

struct Judgement {
  std::string aim, measured;
  Verdict verdict = Verdict::not_measured;
  std::string note;  ///< reason why the verdict is uncertain; may be empty
};

/// Returns whether the cost is at most `limit`. A cost that is never reached is a miss, and so is an upper bound above the limit.
Verdict at_most(const std::optional<Reached>& cost, double limit);
/// Returns whether a measured error is at most `limit`, with a note if its 95 % interval contains the limit.
Judgement keeps(const Confidence& error, double limit);

/// Returns whether the default strategy's runs at `tolerance` have at most that error. A tolerance that was not tried because a
/// larger one ran out of time is a miss.
Judgement keeps_tolerance(std::span<const RunGroup> groups, double tolerance);

/// Judges the slope of an error against time from the first to the last point, in log-log.
Judgement judge_slope(std::span<const CurvePoint> curve);
/// Judges ratios of estimated over true error, by solve. `solves` says of which solves, in the plural.
Judgement judge_estimates(std::string_view solves, std::span<const double> ratios);
/// Judges the most memory, in bytes, that a solve of a room of about 420 faces held, with no option but the scene; 0 if it was not
/// measured.
Judgement judge_memory(std::uint64_t bytes);
/// Judges which share of the points had errors within two of the told ones, by solve.
Judgement judge_told_errors(std::span<const double> within_two);
/// Judges how often the estimate of a published step is far above that of the step before.
Judgement judge_rises(std::uint64_t rises, std::uint64_t steps);

/// Returns the judgements of all targets on the scenes, in order. `machine_gain` is the median of
/// Measurements::two_threads_faster.
std::vector<Judgement> judge(std::span<const SceneContest> contests, double yardstick_s, double machine_gain);
/// Compares solves with two threads and with one. If even fully parallel work gained too little, a miss is blamed on the machine.
Judgement judge_thread_gain(double one_s, double two_s, double machine_gain);

}  // namespace alvor::bench
