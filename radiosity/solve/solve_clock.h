#pragma once

#include <algorithm>
#include <chrono>
#include <functional>
#include <thread>

namespace alvor {

/// Measures the wall seconds of a solve, without its pauses.
class SolveClock {
 public:
  double elapsed_s() const { return seconds(Clock::now() - start_ - paused_); }
  /// Waits, and does not count the time. Returns early once must_stop() is true.
  void pause(double duration_s, const std::function<bool()>& must_stop) {
    const auto before = Clock::now(), end = before + of(duration_s);
    while (!must_stop() && Clock::now() < end)
      std::this_thread::sleep_for(std::min<Clock::duration>(end - Clock::now(), most_nap));
    paused_ += Clock::now() - before;
  }
  /// Adds seconds that had elapsed before this clock was made.
  void add_elapsed(double elapsed_s) { start_ -= of(elapsed_s); }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::milliseconds most_nap{2};  // so soon is heeded what ends a pause
  static Clock::duration of(double s) { return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(s)); }
  static double seconds(Clock::duration d) { return std::chrono::duration<double>(d).count(); }
  Clock::time_point start_ = Clock::now();
  Clock::duration paused_{};
};

}  // namespace alvor
