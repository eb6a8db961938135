#pragma once
// Opens the sockets of a listening address.

#include "server/base/descriptor.h"

#include <functional>
#include <string>
#include <vector>

namespace alvor {

/// The sockets of one address; non-blocking. A socket file (unix:PATH) is removed when this goes.
class ListeningSockets {
 public:
  /// `address` is HOST:PORT, where port 0 takes a free one and every address of HOST is listened on, or unix:PATH, which only the
  /// server's user and group may open (mode 0660). Two servers never share an address; a socket file that nobody listens on is
  /// replaced. Throws std::invalid_argument where it is no such address, std::runtime_error where it cannot listen there.
  explicit ListeningSockets(const std::string& address);
  /// Throws std::invalid_argument where it is no such address.
  static void check(const std::string& address);
  ~ListeningSockets();
  ListeningSockets(const ListeningSockets&) = delete;
  ListeningSockets& operator=(const ListeningSockets&) = delete;

  const std::vector<Descriptor>& all() const { return all_; }
  /// AF_INET, AF_INET6 or AF_UNIX.
  int family(const Descriptor& socket) const;
  int port() const { return port_; }  ///< 0 for a Unix socket
  bool is_unix() const { return !file_.empty(); }
  /// The address with the port that was taken.
  const std::string& address() const { return address_; }

  /// Nobody finds a socket file any more; whoever listens next there may make its own.
  void remove_file();

  /// Connects as a client on this machine would; blocking, each operation takes 3 s at most. Over TCP, `before` is told the port
  /// of the client's end before the connection is made. Returns a descriptor that is not open where it fails.
  Descriptor connect(const std::function<void(int)>& before) const;

 private:
  Descriptor connect_tcp(const std::function<void(int)>& before) const;
  void open_tcp(const std::string& host, const std::string& port);
  void open_unix(const std::string& file);

  std::string address_;
  std::string file_;
  bool is_file_removed_ = false;
  int port_ = 0;
  std::vector<Descriptor> all_;
};

}  // namespace alvor
