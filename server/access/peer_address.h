#pragma once
// The address of a connection's peer.

#include <sys/socket.h>

#include <string>

namespace alvor {

/// Returns the network for limits by address: the bytes of an IPv4 address, or of the /64 network that one subscriber of IPv6
/// has. Empty for other families.
std::string network_of(const sockaddr& peer);

/// Returns whether the address is a loopback address.
bool is_this_machine(const sockaddr& peer);

/// Returns the peer's name as in gRPC's ServerContext::peer(): "ipv4:127.0.0.1:50051", "ipv6:%5B::1%5D:50051". Empty for families
/// other than IPv4 and IPv6.
std::string grpc_name_of(const sockaddr& peer);

/// Returns the port, or 0 for families other than IPv4 and IPv6.
int port_of(const sockaddr& peer);

}  // namespace alvor
