#include "server/access/listening_sockets.h"

#include "server/access/listening.h"

#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <memory>
#include <stdexcept>

namespace alvor {

namespace {

// Most connections that may arrive before the accepting thread looks again.
constexpr int backlog = 128;
constexpr timeval patience{3, 0};

/// A socket address of any family.
struct SocketAddress {
  sockaddr_storage bytes{};
  socklen_t size = sizeof(sockaddr_storage);

  const sockaddr* get() const { return reinterpret_cast<const sockaddr*>(&bytes); }
  sockaddr* get() { return reinterpret_cast<sockaddr*>(&bytes); }
  template <class Family>
  Family& as() {
    return reinterpret_cast<Family&>(bytes);
  }
  bool has_port() const { return bytes.ss_family == AF_INET || bytes.ss_family == AF_INET6; }
  in_port_t& port() { return bytes.ss_family == AF_INET ? as<sockaddr_in>().sin_port : as<sockaddr_in6>().sin6_port; }
};

SocketAddress own_address(int socket) {
  SocketAddress own;
  getsockname(socket, own.get(), &own.size);
  return own;
}

SocketAddress unix_address(const std::string& file) {
  SocketAddress address;
  auto& to = address.as<sockaddr_un>();
  to.sun_family = AF_UNIX;
  if (file.empty() || file.size() >= sizeof to.sun_path)
    throw std::invalid_argument("'" + file + "' is no path for a Unix socket: it must have 1 to " +
                                std::to_string(sizeof to.sun_path - 1) + " bytes");
  std::memcpy(to.sun_path, file.c_str(), file.size() + 1);
  address.size = sizeof to;
  return address;
}

void set(int socket, int level, int option, int value) { setsockopt(socket, level, option, &value, sizeof value); }

/// Returns whether nobody listens on the socket file any more.
bool is_left_behind(const SocketAddress& address) {
  const Descriptor client(socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  return ::connect(client.get(), address.get(), address.size) != 0 && errno == ECONNREFUSED;
}

/// Returns a listening socket; not open if the system refuses.
Descriptor listen_on(const SocketAddress& address) {
  Descriptor made(socket(address.bytes.ss_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  if (address.has_port()) set(made.get(), SOL_SOCKET, SO_REUSEADDR, 1);
  // "::" takes IPv4 too, as usual for servers. If 0.0.0.0 is listened on as well, it has its own socket.
  if (address.bytes.ss_family == AF_INET6) set(made.get(), IPPROTO_IPV6, IPV6_V6ONLY, 0);
  if (!made.is_open() || bind(made.get(), address.get(), address.size) != 0) return {};
  if (!address.has_port())
    chmod(reinterpret_cast<const sockaddr_un&>(address.bytes).sun_path, 0660);  // before listen(), so nobody can connect yet
  return listen(made.get(), backlog) == 0 ? std::move(made) : Descriptor();
}

using AddressList = std::unique_ptr<addrinfo, decltype(&freeaddrinfo)>;

AddressList resolved(const std::string& host, const std::string& port) {
  addrinfo hints{}, *found = nullptr;
  hints.ai_flags = AI_PASSIVE | AI_NUMERICSERV;
  hints.ai_socktype = SOCK_STREAM;
  getaddrinfo(host.c_str(), port.c_str(), &hints, &found);
  return {found, &freeaddrinfo};
}

/// Replaces a wildcard address by the loopback address.
void make_reachable(SocketAddress& address) {
  if (address.bytes.ss_family == AF_INET) {
    auto& to = address.as<sockaddr_in>();
    if (to.sin_addr.s_addr == htonl(INADDR_ANY)) to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  } else {
    auto& to = address.as<sockaddr_in6>();
    if (IN6_IS_ADDR_UNSPECIFIED(&to.sin6_addr)) to.sin6_addr = in6addr_loopback;
  }
}

Descriptor blocking_socket(int family) {
  Descriptor client(socket(family, SOCK_STREAM | SOCK_CLOEXEC, 0));
  for (const int option : {SO_RCVTIMEO, SO_SNDTIMEO}) setsockopt(client.get(), SOL_SOCKET, option, &patience, sizeof patience);
  return client;
}

std::string path_in(const std::string& address) { return address.substr(std::string("unix:").size()); }

/// Splits HOST:PORT. Throws std::invalid_argument if it is malformed.
std::pair<std::string, std::string> host_and_port(const std::string& address) {
  const std::size_t colon = address.rfind(':');
  std::string host = address.substr(0, colon);
  const std::string port = colon == std::string::npos ? "" : address.substr(colon + 1);
  const bool is_port = !port.empty() && port.size() <= 5 && port.find_first_not_of("0123456789") == std::string::npos;
  if (host.empty() || !is_port || std::stoi(port) > 65535) throw std::invalid_argument("'" + address + "' is not HOST:PORT");
  if (host.starts_with('[') && host.ends_with(']')) host = host.substr(1, host.size() - 2);
  return {host, port};
}

}  // namespace

void ListeningSockets::check(const std::string& address) {
  if (alvor::is_unix(address)) unix_address(path_in(address));
  else host_and_port(address);
}

ListeningSockets::ListeningSockets(const std::string& address) : address_(address) {
  if (alvor::is_unix(address)) {
    open_unix(path_in(address));
    return;
  }
  const auto [host, port] = host_and_port(address);
  open_tcp(host, port);
}

void ListeningSockets::open_tcp(const std::string& host, const std::string& port) {
  const AddressList found = resolved(host, port);
  for (const addrinfo* each = found.get(); each; each = each->ai_next) {
    SocketAddress address;
    std::memcpy(&address.bytes, each->ai_addr, each->ai_addrlen);
    address.size = each->ai_addrlen;
    if (port_ > 0) address.port() = htons(static_cast<std::uint16_t>(port_));
    Descriptor made = listen_on(address);
    if (!made.is_open()) continue;
    if (port_ == 0) port_ = ntohs(own_address(made.get()).port());
    all_.push_back(std::move(made));
  }
  if (all_.empty()) throw std::runtime_error(cannot_listen(address_));
  address_ = with_port(address_, port_);
}

void ListeningSockets::open_unix(const std::string& file) {
  const SocketAddress address = unix_address(file);
  struct stat found {};
  const bool is_stale = lstat(file.c_str(), &found) == 0 && S_ISSOCK(found.st_mode) && is_left_behind(address);
  if (is_stale) unlink(file.c_str());
  Descriptor made = listen_on(address);
  if (!made.is_open()) throw std::runtime_error("cannot listen on " + address_ + ": " + std::strerror(errno));
  file_ = file;
  all_.push_back(std::move(made));
}

ListeningSockets::~ListeningSockets() { remove_file(); }

void ListeningSockets::remove_file() {
  if (!file_.empty() && !std::exchange(is_file_removed_, true)) unlink(file_.c_str());
}

int ListeningSockets::family(const Descriptor& socket) const { return own_address(socket.get()).bytes.ss_family; }

Descriptor ListeningSockets::connect(const std::function<void(int)>& before) const {
  if (!is_unix()) return connect_tcp(before);
  Descriptor client = blocking_socket(AF_UNIX);
  const SocketAddress to = unix_address(file_);
  return ::connect(client.get(), to.get(), to.size) == 0 ? std::move(client) : Descriptor();
}

Descriptor ListeningSockets::connect_tcp(const std::function<void(int)>& before) const {
  SocketAddress to = own_address(all_.front().get());
  make_reachable(to);
  SocketAddress from = to;
  from.port() = 0;
  Descriptor client = blocking_socket(to.bytes.ss_family);
  if (bind(client.get(), from.get(), from.size) != 0) return {};
  before(ntohs(own_address(client.get()).port()));
  return ::connect(client.get(), to.get(), to.size) == 0 ? std::move(client) : Descriptor();
}

}  // namespace alvor
