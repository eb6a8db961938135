#pragma once
// A line of progress on stderr.

#include <chrono>
#include <optional>
#include <string>

namespace alvor {

/// Prints a line of progress. On a terminal the line is redrawn, at most ten times a second; to a pipe it is printed at most once
/// a second. Prints nothing with --quiet.
class StatusLine {
 public:
  StatusLine();
  ~StatusLine();  ///< leaves the cursor on a new line
  StatusLine(const StatusLine&) = delete;
  StatusLine& operator=(const StatusLine&) = delete;

  bool on_terminal() const { return terminal_; }
  /// Returns whether enough time has passed to show the line again.
  bool due() const;
  void show(const std::string& text);

 private:
  using Clock = std::chrono::steady_clock;

  bool terminal_;
  std::optional<Clock::time_point> shown_;
};

/// Returns a bar such as "[####----]" for a fraction in [0, 1].
std::string progress_bar(double share);

}  // namespace alvor
