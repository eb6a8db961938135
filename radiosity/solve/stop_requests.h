#pragma once
// Requests to end a solve that could go on: of any rank, and of the clock of the first.

#include "radiosity/solve/solve_clock.h"
#include "radiosity/solve/solver.h"

#include <array>
#include <atomic>
#include <cstdint>

namespace alvor {

/// The requests that a solve has to heed, as this rank or all ranks know of them. Borrows the control and the clock.
class StopRequests {
 public:
  StopRequests(const SolveControl& control, const SolveClock& clock, double time_limit_s)
      : control_(control), clock_(clock), time_limit_s_(time_limit_s) {}

  /// Some requests. One that was made stays made, but for an edit when a request to park comes.
  struct Made {
    bool cancelled = false, memory = false, time_limit = false, parked = false, edited = false;

    /// Returns whether to give up even in the middle of an exchange. A request to park is none: a solve that went on from the
    /// middle of an exchange would go on differently.
    bool break_off() const { return cancelled || memory || time_limit; }
    bool any() const { return break_off() || parked || edited; }
  };
  /// Returns the requests that this rank knows of. An edit that comes with a request to park waits until the solve is resumed:
  /// it would break off the exchange in which the solve cannot be parked. Safe from any thread.
  Made made_here() const {
    const bool is_parked = control_.park.stop_requested();
    return {control_.stop.stop_requested(), control_.short_of_memory.stop_requested(),
            control_.ranks->is_first() && clock_.elapsed_s() > time_limit_s_, is_parked,
            !is_parked && heeds_edits_ && is_edited()};
  }
  /// Collective. Returns the requests that any rank knows of.
  const Made& ask() {
    const Made here = made_here();
    std::array<std::uint64_t, 5> counts{here.cancelled, here.memory, here.time_limit, here.parked, here.edited};
    control_.ranks->sum(counts);
    return made_ = {counts[0] > 0, counts[1] > 0, counts[2] > 0, counts[3] > 0, counts[4] > 0 && counts[3] == 0};
  }
  /// Collective. Returns whether there is an edit that must wait until the solve is resumed.
  bool has_edit_to_wait() const { return control_.ranks->any_of(control_.park.stop_requested() && is_edited()); }
  /// Makes edits count or not. A solve that has just taken one does not heed another before it has shown something, else a stream
  /// of edits would never be seen.
  void heed_edits(bool heeds) { heeds_edits_ = heeds; }
  /// Returns why the solve ends, by the last call of ask().
  StopReason reason() const {
    if (made_.cancelled) return StopReason::cancelled;
    if (made_.memory) return StopReason::memory;
    if (made_.time_limit) return StopReason::time_limit;
    return made_.parked ? StopReason::parked : StopReason::edited;
  }

 private:
  bool is_edited() const { return control_.is_edited && control_.is_edited(); }

  const SolveControl& control_;
  const SolveClock& clock_;
  const double time_limit_s_;
  std::atomic<bool> heeds_edits_ = true;
  Made made_;
};

}  // namespace alvor
