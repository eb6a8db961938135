#pragma once
// Turns Ctrl-C into a stop request.

#include <atomic>
#include <csignal>
#include <stop_token>
#include <thread>

namespace alvor {

/// While it exists, the first SIGINT or SIGTERM requests a stop; the next one ends the process as usual. Construct it before
/// other threads start: they must inherit the blocked signals.
class Interrupt {
 public:
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  std::stop_token token() const { return source_.get_token(); }

 private:
  void listen();

  sigset_t stopping_;  ///< the signals that request a stop
  sigset_t previous_;  ///< the signals that were blocked before
  std::stop_source source_;
  std::atomic<bool> over_ = false;
  std::thread listener_;
};

}  // namespace alvor
