#include "server/listening_socket.h"

#include "server/listening.h"

#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <utility>

namespace alvor {

namespace {

constexpr std::string_view unix_scheme = "unix:";
constexpr int backlog = 511;

struct Address {
  std::string host, port;
};

Address parse(const std::string& address) {
  const std::size_t colon = address.rfind(':');
  const std::string port = colon == std::string::npos ? "" : address.substr(colon + 1);
  if (colon == 0 || port.empty() || port.size() > 5 || port.find_first_not_of("0123456789") != std::string::npos ||
      std::stoi(port) > 65535)
    throw std::invalid_argument("--web: '" + address + "' is not HOST:PORT");
  std::string host = address.substr(0, colon);
  if (host.starts_with('[') && host.ends_with(']')) host = host.substr(1, host.size() - 2);
  return {host, port};
}

int open_socket(int family) { return socket(family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0); }

void set_option(int descriptor, int level, int option, int value) {
  (void)setsockopt(descriptor, level, option, &value, sizeof value);
}

/// Returns a listening descriptor, or -1. Not SO_REUSEPORT: two servers must not share an address unknowingly.
int listen_at(const addrinfo& place) {
  const int descriptor = open_socket(place.ai_family);
  if (descriptor < 0) return -1;
  set_option(descriptor, SOL_SOCKET, SO_REUSEADDR, 1);
  if (place.ai_family == AF_INET6) set_option(descriptor, IPPROTO_IPV6, IPV6_V6ONLY, 0);
  if (bind(descriptor, place.ai_addr, place.ai_addrlen) == 0 && listen(descriptor, backlog) == 0) return descriptor;
  close(descriptor);
  return -1;
}

int port_of(int descriptor) {
  sockaddr_storage name{};
  socklen_t length = sizeof name;
  getsockname(descriptor, reinterpret_cast<sockaddr*>(&name), &length);
  const auto port = name.ss_family == AF_INET6 ? reinterpret_cast<const sockaddr_in6&>(name).sin6_port
                                               : reinterpret_cast<const sockaddr_in&>(name).sin_port;
  return ntohs(port);
}

/// Whether it is a socket at which nobody listens.
bool is_left_behind(const sockaddr_un& name) {
  struct stat status {};
  if (lstat(name.sun_path, &status) != 0 || !S_ISSOCK(status.st_mode)) return false;
  const int probe = open_socket(AF_UNIX);
  const bool is_refused = connect(probe, reinterpret_cast<const sockaddr*>(&name), sizeof name) != 0 && errno == ECONNREFUSED;
  close(probe);
  return is_refused;
}

}  // namespace

void check_web_address(const std::string& address) {
  if (!address.starts_with(unix_scheme)) (void)parse(address);
}

ListeningSocket::ListeningSocket(const std::string& address) {
  if (address.starts_with(unix_scheme)) listen_on_path(address.substr(unix_scheme.size()));
  else listen_on_host(address);
}

ListeningSocket::~ListeningSocket() {
  remove_file();
  if (descriptor_ >= 0) close(descriptor_);
}

void ListeningSocket::listen_on_host(const std::string& address) {
  const Address parts = parse(address);
  addrinfo hints{}, *found = nullptr;
  hints.ai_socktype = SOCK_STREAM;
  hints.ai_flags = AI_PASSIVE | AI_NUMERICSERV;
  if (getaddrinfo(parts.host.c_str(), parts.port.c_str(), &hints, &found) != 0) found = nullptr;
  const std::unique_ptr<addrinfo, void (*)(addrinfo*)> places(found, [](addrinfo* list) {
    if (list) freeaddrinfo(list);
  });
  for (const addrinfo* place = found; place && descriptor_ < 0; place = place->ai_next) {
    descriptor_ = listen_at(*place);
    family_ = place->ai_family;
  }
  if (descriptor_ < 0) throw std::invalid_argument("--web: " + cannot_listen(address));
  port_ = port_of(descriptor_);
}

void ListeningSocket::listen_on_path(const std::string& path) {
  sockaddr_un name{};
  name.sun_family = family_ = AF_UNIX;
  if (path.empty() || path.size() >= sizeof name.sun_path)
    throw std::invalid_argument("--web: '" + path + "' is no path for a Unix socket: it must have 1 to " +
                                std::to_string(sizeof name.sun_path - 1) + " bytes");
  std::memcpy(name.sun_path, path.data(), path.size());
  if (is_left_behind(name)) unlink(name.sun_path);
  descriptor_ = open_socket(AF_UNIX);
  if (descriptor_ >= 0 && bind(descriptor_, reinterpret_cast<const sockaddr*>(&name), sizeof name) == 0) path_ = path;
  // Nobody can connect before listen().
  if (!path_.empty() && chmod(name.sun_path, 0660) == 0 && listen(descriptor_, backlog) == 0) return;
  const std::string reason = std::strerror(errno);
  remove_file();
  if (descriptor_ >= 0) close(descriptor_);
  throw std::invalid_argument("--web: cannot listen on unix:" + path + ": " + reason);
}

bool ListeningSocket::is_unix() const { return family_ == AF_UNIX; }

int ListeningSocket::release() { return std::exchange(descriptor_, -1); }

void ListeningSocket::remove_file() {
  if (!path_.empty()) unlink(path_.c_str());
  path_.clear();
}

}  // namespace alvor
