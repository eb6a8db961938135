#include "client/command/commands/interrupt.h"

namespace alvor {

namespace {

constexpr int wake_up = SIGUSR1;  // ends the listener's wait if no signal came

sigset_t with_wake_up(sigset_t signals) {
  sigaddset(&signals, wake_up);
  return signals;
}

}  // namespace

Interrupt::Interrupt() {
  sigemptyset(&stopping_);
  sigaddset(&stopping_, SIGINT);
  sigaddset(&stopping_, SIGTERM);
  const sigset_t blocked = with_wake_up(stopping_);
  pthread_sigmask(SIG_BLOCK, &blocked, &previous_);
  listener_ = std::thread([this] { listen(); });
}

Interrupt::~Interrupt() {
  over_ = true;
  over_.notify_all();
  pthread_kill(listener_.native_handle(), wake_up);
  listener_.join();
  pthread_sigmask(SIG_SETMASK, &previous_, nullptr);
}

// Waits for signals in a thread: a stop request runs callbacks, which a signal handler must not do.
void Interrupt::listen() {
  const sigset_t awaited = with_wake_up(stopping_);
  int caught = 0;
  if (sigwait(&awaited, &caught) != 0 || caught == wake_up) return;
  pthread_sigmask(SIG_UNBLOCK, &stopping_, nullptr);  // the next one ends the process as usual
  source_.request_stop();
  over_.wait(false);
}

}  // namespace alvor
