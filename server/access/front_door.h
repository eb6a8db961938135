#pragma once
// Accepts the connections of a gRPC server. gRPC's own listener stops for good when descriptors run out, and knows no bounds.

#include "server/access/listening_sockets.h"
#include "server/base/mutex.h"

#include <sys/socket.h>
#include <sys/types.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <thread>

namespace alvor {

/// Connections that one listener holds at a time. Where all places are taken, the oldest connection that has sent nothing yet
/// gives way to a new one; else the new one is closed at once.
struct ConnectionLimits {
  std::size_t in_all = 1000;
  /// From one IPv4 address or one IPv6 network of 64 bits. Connections from this machine do not count: behind a proxy all come
  /// from there.
  std::size_t by_address = 100;
};

/// Thread-safe.
class FrontDoor {
 public:
  /// Listens from now on; connections wait until open(). Throws as ListeningSockets does.
  FrontDoor(const std::string& address, const ConnectionLimits& limits);
  /// As close().
  ~FrontDoor();

  /// Accepts connections, on a thread of its own, until close(). `take` is given each as a non-blocking socket, which it then
  /// owns; `died` is called at most once, from that thread, if nothing can be accepted any more. Where descriptors run out,
  /// connections wait until there are some.
  void open(std::function<void(int)> take, std::function<void()> died);
  void close();

  /// A connection from inside this process, for which there is always a place. Not open where it fails. One at a time.
  Descriptor connect_as_probe();
  /// Ends the connection that received the most bytes lately (within the last 5 to 10 s), if these are `least` or more: what it
  /// sent takes memory. Returns whether there was one. Connections over Unix sockets are left alone.
  bool end_greediest(std::uint64_t least);

  /// Ends the connection of a peer as gRPC names it: "ipv4:127.0.0.1:50051". Returns whether there was one.
  bool end(const std::string& peer);

  int port() const { return sockets_.port(); }
  const std::string& address() const { return sockets_.address(); }
  struct Counts {
    std::size_t open = 0;       ///< now
    std::uint64_t refused = 0;  ///< since it was made, beyond the limits
  };
  Counts counts() const;

 private:
  using Clock = std::chrono::steady_clock;
  /// gRPC owns the descriptor and closes it. The inode tells whether its number still stands for the same connection.
  struct Connection {
    ino_t inode = 0;
    std::uint64_t number = 0;              ///< grows: the order in which they were accepted
    std::string address;                   ///< "": counts for no address
    std::string peer;                      ///< "": a Unix socket
    std::uint64_t received = 0, then = 0;  ///< bytes when it was looked at last, and the time before that
  };

  void run();
  bool accept_round(int listening);
  void admit(Descriptor accepted, const sockaddr& peer);
  bool has_place_for(const std::string& address) ALVOR_REQUIRES(lock_);
  bool end_oldest_silent() ALVOR_REQUIRES(lock_);
  void forget_ended() ALVOR_REQUIRES(lock_);
  void forget(std::map<int, Connection>::iterator ended) ALVOR_REQUIRES(lock_);
  void look() ALVOR_REQUIRES(lock_);

  const ListeningSockets sockets_;
  const ConnectionLimits limits_;
  const Descriptor wake_;
  std::function<void(int)> take_;
  std::function<void()> died_;
  std::atomic<int> probe_port_ = 0;
  mutable Mutex lock_;
  std::map<int, Connection> connections_
      ALVOR_GUARDED_BY(lock_);  ///< by the number of the descriptor; some may have ended since they were looked at
  std::map<std::string, std::size_t> by_address_ ALVOR_GUARDED_BY(lock_);
  std::uint64_t accepted_ ALVOR_GUARDED_BY(lock_) = 0, refused_ ALVOR_GUARDED_BY(lock_) = 0;
  Clock::time_point last_look_ ALVOR_GUARDED_BY(lock_), last_traffic_ ALVOR_GUARDED_BY(lock_);
  std::thread thread_;
};

}  // namespace alvor
