#pragma once
// Accepts the connections of a gRPC server. gRPC's own listener stops for good when descriptors run out, and has no limits.

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

/// Limits of the connections that one listener holds at a time. At a limit, the oldest connection that has sent nothing yet is
/// closed for a new one; if there is none, the new one is closed.
struct ConnectionLimits {
  std::size_t in_all = 1000;
  /// Limit for one IPv4 address or one IPv6 network of 64 bits. Connections from this machine do not count, because behind a
  /// proxy all connections come from there.
  std::size_t by_address = 100;
};

/// Accepts connections within limits and hands them to gRPC. Thread-safe.
class FrontDoor {
 public:
  /// Listens from now on; connections wait until open(). Throws as ListeningSockets does.
  FrontDoor(const std::string& address, const ConnectionLimits& limits);
  /// Calls close().
  ~FrontDoor();

  /// Accepts connections, on a thread of its own, until close(). Calls `take` with each as a non-blocking socket, which `take`
  /// then owns. Calls `died` from that thread, at most once, if nothing can be accepted any more. If descriptors run out,
  /// connections wait until some are free.
  void open(std::function<void(int)> take, std::function<void()> died);
  void close();

  /// Returns a connection from inside this process, which is always admitted; not open if it failed. One at a time.
  Descriptor connect_as_probe();
  /// Closes the connection that received the most bytes in the last 5 to 10 s, if these are `least` or more, because what it sent
  /// takes memory. Returns whether it closed one. Connections over Unix sockets are left alone.
  bool end_greediest(std::uint64_t least);

  /// Closes the connection of a peer, named as gRPC does: "ipv4:127.0.0.1:50051". Returns whether there was one.
  bool end(const std::string& peer);

  int port() const { return sockets_.port(); }
  const std::string& address() const { return sockets_.address(); }
  struct Counts {
    std::size_t open = 0;       ///< open connections now
    std::uint64_t refused = 0;  ///< connections refused beyond the limits since construction
  };
  Counts counts() const;

 private:
  using Clock = std::chrono::steady_clock;
  /// A connection that was handed to gRPC, which owns the descriptor and closes it. The inode tells whether the descriptor's
  /// number still belongs to the same connection.
  struct Connection {
    ino_t inode = 0;
    std::uint64_t number = 0;              ///< increases in the order of accepting
    std::string address;                   ///< address it counts for; "": none
    std::string peer;                      ///< "": a Unix socket
    std::uint64_t received = 0, then = 0;  ///< bytes received at the last look, and at the one before
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
  std::map<int, Connection> connections_ ALVOR_GUARDED_BY(lock_);  ///< by descriptor; some may have ended since the last look
  std::map<std::string, std::size_t> by_address_ ALVOR_GUARDED_BY(lock_);
  std::uint64_t accepted_ ALVOR_GUARDED_BY(lock_) = 0, refused_ ALVOR_GUARDED_BY(lock_) = 0;
  Clock::time_point last_look_ ALVOR_GUARDED_BY(lock_), last_traffic_ ALVOR_GUARDED_BY(lock_);
  std::thread thread_;
};

}  // namespace alvor
