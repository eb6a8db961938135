#pragma once
// What was aimed at, and whether it was met.

#include "bench/error_vs_time/contest.h"

#include <string>
#include <vector>

namespace alvor::bench {

enum class Verdict { met, missed, not_measured };
std::string_view text(Verdict verdict);

struct Judgement {
  std::string aim, measured;
  Verdict verdict = Verdict::not_measured;
  std::string note;  ///< what makes the verdict less than certain; may be empty
};

/// Nothing reached misses any limit; an upper bound above the limit does too.
Verdict at_most(const std::optional<Reached>& cost, double limit);
/// Whether a measured error keeps `limit`, and a note where its 95 % interval does not tell.
Judgement keeps(const Confidence& error, double limit);

/// Whether the default strategy's runs at `tolerance` are that good. One that was not tried after a looser one had run out of
/// time is a miss.
Judgement keeps_tolerance(std::span<const RunGroup> groups, double tolerance);

/// All targets, in order.
/// `machine_gain`: see Measurements::two_threads_faster, the median.
std::vector<Judgement> judge(std::span<const SceneContest> contests, double yardstick_s, double machine_gain);
/// Two threads against one, of solves. Where even work that is all parallel gained too little, a miss is the machine's.
Judgement judge_thread_gain(double one_s, double two_s, double machine_gain);

}  // namespace alvor::bench
