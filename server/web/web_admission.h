#pragma once
// Who may connect.

#include "server/base/mutex.h"
#include "server/web/web_connection.h"

#include <cstddef>
#include <list>
#include <map>
#include <memory>
#include <string>

namespace alvor {

/// The connections that are open, within the limits on their number. Where a limit is reached, a connection that waits for a
/// request gives way to the new one: the oldest of the address that has most (at the limit of one address: the oldest of that).
/// Where none waits, the new one is not let in. Any thread may use it.
class WebAdmission {
 public:
  explicit WebAdmission(const WebLimits& limits) : limits_(limits) {}

  /// `address`: empty where connections have none. False: it is not let in.
  bool admit(const std::shared_ptr<WebConnection>& connection, const std::string& address);
  void leave(const WebConnection* connection);
  /// Closes one that waits, where there is one.
  void make_room();
  /// Nobody is let in any more; see WebConnection::stop.
  void stop();
  /// Waits until all have left, but no longer than this.
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
