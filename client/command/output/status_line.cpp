#include "client/command/output/status_line.h"

#include "client/command/output/notes.h"

#include <cmath>

#include <unistd.h>

namespace alvor {

StatusLine::StatusLine() : terminal_(isatty(STDERR_FILENO) == 1) {}

StatusLine::~StatusLine() {
  if (terminal_ && shown_) progress() << '\n';
}

bool StatusLine::due() const {
  const std::chrono::milliseconds pause(terminal_ ? 100 : 1000);
  return !shown_ || Clock::now() - *shown_ >= pause;
}

void StatusLine::show(const std::string& text) {
  shown_ = Clock::now();
  constexpr const char* erase_rest = "\x1b[K";
  progress() << (terminal_ ? "\r" + text + erase_rest : text + "\n") << std::flush;
}

std::string progress_bar(double share) {
  constexpr int width = 24;
  const auto full = static_cast<std::size_t>(std::lround(share * width));
  return std::string("[").append(full, '#').append(width - full, '-') + "]";
}

}  // namespace alvor
