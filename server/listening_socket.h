#pragma once
// The socket that browsers connect to.

#include <string>

namespace alvor {

/// Throws std::invalid_argument that begins with "--web: " for what is neither HOST:PORT nor unix:PATH.
void check_web_address(const std::string& address);

/// Listens from when it is made until it is destroyed, or release() gives the descriptor away.
class ListeningSocket {
 public:
  /// HOST:PORT, port 0 for a free one, or unix:PATH. A Unix socket is for its user and group (0660); a file that a server left
  /// behind is replaced, and removed at the end. Throws std::invalid_argument that begins with "--web: ".
  explicit ListeningSocket(const std::string& address);
  ~ListeningSocket();
  ListeningSocket(const ListeningSocket&) = delete;
  ListeningSocket& operator=(const ListeningSocket&) = delete;

  bool is_unix() const;
  /// AF_INET, AF_INET6 or AF_UNIX.
  int family() const { return family_; }
  /// Of TCP.
  int port() const { return port_; }
  /// The listening descriptor, which the caller closes.
  int release();
  /// Nobody finds a Unix socket any more; whoever listens next there may make its own.
  void remove_file();

 private:
  void listen_on_path(const std::string& path);
  void listen_on_host(const std::string& address);

  std::string path_;  // of the file that is to be removed
  int family_ = 0, port_ = 0, descriptor_ = -1;
};

}  // namespace alvor
