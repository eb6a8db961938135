#pragma once
// Looks every few seconds whether a new connection is served, as a client would.

#include "server/access/front_door.h"
#include "server/base/mutex.h"

#include <functional>
#include <thread>

namespace alvor {

/// Whether a new connection gets an answer within 3 s: SETTINGS of HTTP/2, or of TLS any answer to its hello.
bool is_answered(FrontDoor& door, bool with_tls);

class SelfProbe {
 public:
  /// `tell` is called from a thread when the answer differs from the one before; the first is taken to be yes. `door` must
  /// outlive this.
  SelfProbe(FrontDoor& door, bool with_tls, std::function<void(bool)> tell);
  /// As stop(); waits for a probe that is under way.
  ~SelfProbe();
  /// When it returns, `tell` is not called any more. Does not wait.
  void stop();

 private:
  void run(FrontDoor& door, bool with_tls);

  const std::function<void(bool)> tell_;
  Mutex lock_;
  Condition stopped_;
  bool is_stopped_ ALVOR_GUARDED_BY(lock_) = false;
  std::thread thread_;
};

}  // namespace alvor
