#pragma once
// Who is at the other end of a connection.

#include <sys/socket.h>

#include <string>

namespace alvor {

/// Returns what limits by address count: the bytes of an IPv4 address, or of the /64 network that one subscriber of IPv6 has.
/// Empty for other families.
std::string network_of(const sockaddr& peer);

/// Whether the address is a loopback address.
bool is_this_machine(const sockaddr& peer);

/// Returns the peer as gRPC's ServerContext::peer() names it: "ipv4:127.0.0.1:50051", "ipv6:%5B::1%5D:50051". Empty for other
/// families than IPv4 and IPv6.
std::string grpc_name_of(const sockaddr& peer);

/// Returns 0 for other families than IPv4 and IPv6.
int port_of(const sockaddr& peer);

}  // namespace alvor
