#pragma once
// Checks every few seconds whether a new connection is served, by connecting as a client would.

#include "server/access/front_door.h"
#include "server/base/mutex.h"

#include <functional>
#include <thread>

namespace alvor {

/// Returns whether a new connection gets an answer within 3 s: HTTP/2 SETTINGS, or with TLS any answer to the hello.
bool is_answered(FrontDoor& door, bool with_tls);

/// Checks the server's own FrontDoor every few seconds.
class SelfProbe {
 public:
  /// Calls `tell`, on another thread, when the result changes; at first it is taken as answered. `door` must outlive this.
  SelfProbe(FrontDoor& door, bool with_tls, std::function<void(bool)> tell);
  /// Calls stop() and waits for a probe that is under way.
  ~SelfProbe();
  /// Stops the checks without waiting. After it returns, `tell` is not called any more.
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
