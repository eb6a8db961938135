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

/// Returns 0 for other families than IPv4 and IPv6.
int port_of(const sockaddr& peer);

}  // namespace alvor
