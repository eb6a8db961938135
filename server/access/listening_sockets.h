#pragma once
// Opens the sockets of a listening address.

#include "server/base/descriptor.h"

#include <functional>
#include <string>
#include <vector>

namespace alvor {

/// The non-blocking listening sockets of one address. The destructor removes a socket file (unix:PATH).
class ListeningSockets {
 public:
  /// Listens on `address`: HOST:PORT, on every address of HOST, where port 0 takes a free one; or unix:PATH, which only the
  /// server's user and group may open (mode 0660). Two servers never share an address; a socket file on which nobody listens is
  /// replaced. Throws std::invalid_argument for a malformed address, std::runtime_error if it cannot listen.
  explicit ListeningSockets(const std::string& address);
  /// Throws std::invalid_argument if `address` is malformed.
  static void check(const std::string& address);
  ~ListeningSockets();
  ListeningSockets(const ListeningSockets&) = delete;
  ListeningSockets& operator=(const ListeningSockets&) = delete;

  const std::vector<Descriptor>& all() const { return all_; }
  /// Returns AF_INET, AF_INET6 or AF_UNIX.
  int family(const Descriptor& socket) const;
  int port() const { return port_; }  ///< 0 for a Unix socket
  bool is_unix() const { return !file_.empty(); }
  /// Returns the address with the port that the system assigned.
  const std::string& address() const { return address_; }

  /// Removes the socket file, so that another server can make its own there.
  void remove_file();

  /// Connects as a client on this machine would. The socket is blocking, with at most 3 s for each operation. Over TCP, calls
  /// `before` with the client's port before connecting. Returns a descriptor that is not open if it failed.
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
