#pragma once
// Requests to end a solve that could go on: of any rank, and of the clock of the first.

#include "radiosity/solve/solve_clock.h"
#include "radiosity/solve/solver.h"

#include <array>
#include <cstdint>

namespace alvor {

/// The requests that a solve has to heed, as this rank or all ranks know of them. Borrows the control and the clock.
class StopRequests {
 public:
  StopRequests(const SolveControl& control, const SolveClock& clock, double time_limit_s)
      : control_(control), clock_(clock), time_limit_s_(time_limit_s) {}

  /// Some requests. One that was made stays made.
  struct Made {
    bool cancelled = false, memory = false, time_limit = false, parked = false;

    /// Returns whether to give up even in the middle of an exchange. A request to park is none: a solve that went on from the
    /// middle of an exchange would go on differently.
    bool break_off() const { return cancelled || memory || time_limit; }
    bool any() const { return break_off() || parked; }
  };
  /// Returns the requests that this rank knows of. Safe from any thread.
  Made made_here() const {
    return {control_.stop.stop_requested(), control_.short_of_memory.stop_requested(),
            control_.ranks->is_first() && clock_.elapsed_s() > time_limit_s_, control_.park.stop_requested()};
  }
  /// Collective. Returns the requests that any rank knows of.
  const Made& ask() {
    const Made here = made_here();
    std::array<std::uint64_t, 4> counts{here.cancelled, here.memory, here.time_limit, here.parked};
    control_.ranks->sum(counts);
    return made_ = {counts[0] > 0, counts[1] > 0, counts[2] > 0, counts[3] > 0};
  }
  /// Returns why the solve ends, by the last call of ask().
  StopReason reason() const {
    if (made_.cancelled) return StopReason::cancelled;
    if (made_.memory) return StopReason::memory;
    return made_.time_limit ? StopReason::time_limit : StopReason::parked;
  }

 private:
  const SolveControl& control_;
  const SolveClock& clock_;
  const double time_limit_s_;
  Made made_;
};

}  // namespace alvor
