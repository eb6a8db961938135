#pragma once
// A line on stderr that says how far something has come.

#include <chrono>
#include <optional>
#include <string>

namespace alvor {

/// Nothing with --quiet. Else on a terminal one line, redrawn at most ten times a second; in a pipe plain lines, at most one a
/// second.
class StatusLine {
 public:
  StatusLine();
  ~StatusLine();  ///< leaves the cursor on a fresh line
  StatusLine(const StatusLine&) = delete;
  StatusLine& operator=(const StatusLine&) = delete;

  bool on_terminal() const { return terminal_; }
  /// Whether it is time to show something again.
  bool due() const;
  void show(const std::string& text);

 private:
  using Clock = std::chrono::steady_clock;

  bool terminal_;
  std::optional<Clock::time_point> shown_;
};

/// "[####----]"
std::string progress_bar(double share);

}  // namespace alvor
