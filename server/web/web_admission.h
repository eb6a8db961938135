#pragma once
// Limits the number of open browser connections.

#include "server/base/mutex.h"
#include "server/web/web_connection.h"

#include <cstddef>
#include <list>
#include <map>
#include <memory>
#include <string>

namespace alvor {

/// The open connections, within the limits on their number. At a limit, a connection that waits for a request is closed for the
/// new one: the oldest of the address that has most connections, or at the limit of one address the oldest of that address. If
/// none waits, the new one is not admitted. Safe from any thread.
class WebAdmission {
 public:
  explicit WebAdmission(const WebLimits& limits) : limits_(limits) {}

  /// Admits a connection; returns false if it is refused. `address` is empty for Unix sockets.
  bool admit(const std::shared_ptr<WebConnection>& connection, const std::string& address);
  void leave(const WebConnection* connection);
  /// Closes one connection that waits for a request, if there is one.
  void make_room();
  /// Admits no connection any more; stops all open ones (WebConnection::stop).
  void stop();
  /// Waits until all connections have left, but at most for `patience`.
  void wait_until_empty(WebLimits::Time patience);
  void close_all();

 private:
  struct Guest {
    std::weak_ptr<WebConnection> connection;
    const WebConnection* key;
    std::string address;
  };
  using Guests = std::list<Guest>;  // the oldest first
  bool evict_from(const std::string& address) ALVOR_REQUIRES(mutex_);
  bool evict_any() ALVOR_REQUIRES(mutex_);
  void erase(Guests::iterator guest) ALVOR_REQUIRES(mutex_);

  const WebLimits limits_;
  Mutex mutex_;
  Condition has_left_;
  Guests guests_ ALVOR_GUARDED_BY(mutex_);
  std::map<const WebConnection*, Guests::iterator> by_connection_ ALVOR_GUARDED_BY(mutex_);
  std::map<std::string, std::size_t> by_address_ ALVOR_GUARDED_BY(mutex_);
  bool is_stopping_ ALVOR_GUARDED_BY(mutex_) = false;
};

}  // namespace alvor
