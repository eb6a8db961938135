#pragma once
// How many descriptors the process may have open, and how they are shared out.

#include <cstddef>

namespace alvor {

/// Raises the soft limit of open descriptors to the hard limit. Returns the limit that then holds.
std::size_t raise_descriptor_limit();

/// The most connections that a listener may hold: `wanted`, but at most `share` of the descriptors beyond those that the
/// database, the log and the listeners themselves need.
std::size_t bounded_connections(std::size_t wanted, double share, std::size_t descriptors);

}  // namespace alvor
