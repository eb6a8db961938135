#include "server/access/front_door.h"

#include "server/access/peer_address.h"

#include <linux/tcp.h>  // newer than netinet/tcp.h: tcpi_bytes_received
#include <netinet/in.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <span>
#include <vector>

namespace alvor {

namespace {

using namespace std::chrono_literals;

constexpr int most_of_round = 64;
constexpr auto between_looks = 1s;
// Least time between two looks; a look takes less than a millisecond.
constexpr auto least_between_looks = 50ms;
constexpr auto traffic_window = 5s;
constexpr int lost_after_ms = 10'000;  // a peer that acknowledges no bytes for this long is lost

bool is_this_process(int connection) {
  ucred peer{};
  socklen_t size = sizeof peer;
  return getsockopt(connection, SOL_SOCKET, SO_PEERCRED, &peer, &size) == 0 && peer.pid == getpid();
}

/// Sets the options that gRPC sets on connections that it accepts itself.
void set_up(int connection) {
  const int yes = 1;
  setsockopt(connection, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
  setsockopt(connection, IPPROTO_TCP, TCP_USER_TIMEOUT, &lost_after_ms, sizeof lost_after_ms);
}

/// Returns the inode of a descriptor, or 0 if it is not open.
ino_t inode_of(int descriptor) {
  struct stat found {};
  return fstat(descriptor, &found) == 0 ? found.st_ino : 0;
}

/// Returns the bytes received over a TCP connection, or 0 for other sockets.
std::uint64_t received_bytes(int connection) {
  tcp_info counts{};
  socklen_t size = sizeof counts;
  return getsockopt(connection, IPPROTO_TCP, TCP_INFO, &counts, &size) == 0 ? counts.tcpi_bytes_received : 0;
}

bool is_silent(int connection) {
  int type = 0;
  socklen_t size = sizeof type;
  const bool is_tcp = getsockopt(connection, SOL_SOCKET, SO_PROTOCOL, &type, &size) == 0 && type == IPPROTO_TCP;
  return is_tcp && received_bytes(connection) == 0;
}

/// Returns whether accepting can go on after this error: it concerns one connection only, or the system lacks something for now.
bool is_passing(int error) {
  constexpr std::array passing{EMFILE, ENFILE,   ENOBUFS,     ENOMEM, ECONNABORTED, EPERM,      EINTR,        EAGAIN,
                               EPROTO, ENETDOWN, ENOPROTOOPT, ENONET, EHOSTDOWN,    EOPNOTSUPP, EHOSTUNREACH, ENETUNREACH};
  return std::ranges::find(passing, error) != passing.end();
}

bool is_short(int error) { return error == EMFILE || error == ENFILE || error == ENOBUFS || error == ENOMEM; }

}  // namespace

FrontDoor::FrontDoor(const std::string& address, const ConnectionLimits& limits)
    : sockets_(address), limits_(limits), wake_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {}

FrontDoor::~FrontDoor() { close(); }

void FrontDoor::open(std::function<void(int)> take, std::function<void()> died) {
  take_ = std::move(take);
  died_ = std::move(died);
  thread_ = std::thread([this] { run(); });
}

void FrontDoor::close() {
  if (!thread_.joinable()) return;
  const std::uint64_t one = 1;
  [[maybe_unused]] const auto written = write(wake_.get(), &one, sizeof one);
  thread_.join();
}

void FrontDoor::run() {
  std::vector<pollfd> waited{{wake_.get(), POLLIN, 0}};
  for (const Descriptor& each : sockets_.all()) waited.push_back({each.get(), POLLIN, 0});
  for (;;) {
    const int count = poll(waited.data(), waited.size(), static_cast<int>(between_looks / 1ms));
    if (count < 0 && !is_passing(errno)) return died_();
    if (waited.front().revents != 0) return;
    for (const pollfd& listening : std::span(waited).subspan(1))
      if (count > 0 && listening.revents != 0 && !accept_round(listening.fd)) return died_();
    Lock hold(lock_);
    look();
  }
}

/// Accepts up to `most_of_round` connections. Returns whether the listening socket is still usable. poll() reports further ones
/// again, so that a flood does not keep the thread from other work.
bool FrontDoor::accept_round(int listening) {
  for (int n = 0; n < most_of_round; ++n) {
    sockaddr_storage from{};
    socklen_t size = sizeof from;
    Descriptor accepted(accept4(listening, reinterpret_cast<sockaddr*>(&from), &size, SOCK_NONBLOCK | SOCK_CLOEXEC));
    if (!accepted.is_open()) {
      const int error = errno;
      if (is_short(error)) std::this_thread::sleep_for(100ms);
      return is_passing(error);
    }
    admit(std::move(accepted), reinterpret_cast<const sockaddr&>(from));
  }
  return true;
}

void FrontDoor::admit(Descriptor accepted, const sockaddr& peer) {
  const bool is_probe = peer.sa_family == AF_UNIX ? is_this_process(accepted.get()) : port_of(peer) == probe_port_;
  const std::string address = is_this_machine(peer) ? "" : network_of(peer);
  {
    Lock hold(lock_);
    if (!is_probe && !has_place_for(address)) {
      ++refused_;
      return;
    }
    if (const auto before = connections_.find(accepted.get()); before != connections_.end()) forget(before);
    connections_[accepted.get()] = {inode_of(accepted.get()), ++accepted_, address, grpc_name_of(peer)};
    if (!address.empty()) ++by_address_[address];
  }
  set_up(accepted.get());
  take_(accepted.release());
}

bool FrontDoor::has_place_for(const std::string& address) {
  const auto known = by_address_.find(address);
  const bool is_full = connections_.size() >= limits_.in_all;
  const bool has_many = known != by_address_.end() && known->second >= limits_.by_address;
  if (!is_full && !has_many) return true;
  if (Clock::now() >= last_look_ + least_between_looks) {
    forget_ended();
    return has_place_for(address);
  }
  return !has_many && end_oldest_silent();
}

/// Closes the oldest connection that has sent nothing. Returns whether there was one.
bool FrontDoor::end_oldest_silent() {
  auto oldest = connections_.end();
  for (auto each = connections_.begin(); each != connections_.end(); ++each)
    if ((oldest == connections_.end() || each->second.number < oldest->second.number) &&
        inode_of(each->first) == each->second.inode && is_silent(each->first))
      oldest = each;
  if (oldest == connections_.end()) return false;
  shutdown(oldest->first, SHUT_RDWR);
  forget(oldest);
  ++refused_;
  return true;
}

void FrontDoor::forget_ended() {
  last_look_ = Clock::now();
  for (auto each = connections_.begin(); each != connections_.end();) {
    const auto next = std::next(each);
    if (inode_of(each->first) != each->second.inode) forget(each);
    each = next;
  }
}

void FrontDoor::forget(std::map<int, Connection>::iterator ended) {
  if (const auto known = by_address_.find(ended->second.address); known != by_address_.end() && --known->second == 0)
    by_address_.erase(known);
  connections_.erase(ended);
}

Descriptor FrontDoor::connect_as_probe() {
  return sockets_.connect([this](int port) { probe_port_ = port; });
}

bool FrontDoor::end_greediest(std::uint64_t least) {
  Lock hold(lock_);
  forget_ended();
  auto greediest = connections_.end();
  for (auto each = connections_.begin(); each != connections_.end(); ++each) {
    const std::uint64_t all = received_bytes(each->first), lately = all - std::min(all, each->second.then);
    if (lately < least) continue;
    least = lately;
    greediest = each;
  }
  if (greediest == connections_.end()) return false;
  shutdown(greediest->first, SHUT_RDWR);
  forget(greediest);
  return true;
}

bool FrontDoor::end(const std::string& peer) {
  Lock hold(lock_);
  forget_ended();
  const auto found = std::ranges::find(connections_, peer, [](const auto& each) { return each.second.peer; });
  if (peer.empty() || found == connections_.end()) return false;
  shutdown(found->first, SHUT_RDWR);
  return true;
}

/// Forgets connections that have ended, and records from time to time how much each received. Requires: the lock.
void FrontDoor::look() {
  const auto now = Clock::now();
  if (now >= last_look_ + between_looks) forget_ended();
  if (now < last_traffic_ + traffic_window) return;
  last_traffic_ = now;
  for (auto& [descriptor, connection] : connections_)
    connection.then = std::exchange(connection.received, received_bytes(descriptor));
}

FrontDoor::Counts FrontDoor::counts() const {
  Lock hold(lock_);
  return {connections_.size(), refused_};
}

}  // namespace alvor
