#include "server/access/peer_address.h"

#include <arpa/inet.h>
#include <netinet/in.h>

namespace alvor {

namespace {

const sockaddr_in& v4(const sockaddr& peer) { return reinterpret_cast<const sockaddr_in&>(peer); }
const sockaddr_in6& v6(const sockaddr& peer) { return reinterpret_cast<const sockaddr_in6&>(peer); }

}  // namespace

std::string network_of(const sockaddr& peer) {
  if (peer.sa_family == AF_INET) return {reinterpret_cast<const char*>(&v4(peer).sin_addr), sizeof(in_addr)};
  if (peer.sa_family != AF_INET6) return {};
  const in6_addr& address = v6(peer).sin6_addr;
  const char* const bytes = reinterpret_cast<const char*>(&address);
  return IN6_IS_ADDR_V4MAPPED(&address) ? std::string(bytes + 12, 4) : std::string(bytes, 8);
}

bool is_this_machine(const sockaddr& peer) {
  constexpr char loopback = 127;  // the first of four bytes
  if (peer.sa_family == AF_INET6 && IN6_IS_ADDR_LOOPBACK(&v6(peer).sin6_addr)) return true;
  const std::string network = network_of(peer);
  return network.size() == 4 && network[0] == loopback;
}

std::string grpc_name_of(const sockaddr& peer) {
  char text[INET6_ADDRSTRLEN] = "";
  const std::string port = ":" + std::to_string(port_of(peer));
  if (peer.sa_family == AF_INET) return "ipv4:" + std::string(inet_ntop(AF_INET, &v4(peer).sin_addr, text, sizeof text)) + port;
  if (peer.sa_family != AF_INET6) return {};
  const in6_addr& address = v6(peer).sin6_addr;
  if (IN6_IS_ADDR_V4MAPPED(&address))
    return "ipv4:" + std::string(inet_ntop(AF_INET, address.s6_addr + 12, text, sizeof text)) + port;
  return "ipv6:%5B" + std::string(inet_ntop(AF_INET6, &address, text, sizeof text)) + "%5D" + port;
}

int port_of(const sockaddr& peer) {
  return peer.sa_family == AF_INET ? ntohs(v4(peer).sin_port) : peer.sa_family == AF_INET6 ? ntohs(v6(peer).sin6_port) : 0;
}

}  // namespace alvor
