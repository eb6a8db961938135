#pragma once
// Limits the open file descriptors of the process and divides them between listeners.

#include <cstddef>

namespace alvor {

/// Raises the soft limit of open descriptors to the hard limit. Returns the limit in force afterwards.
std::size_t raise_descriptor_limit();

/// Returns how many connections a listener may hold: `wanted`, but at most `share` (0 to 1) of the descriptors that remain after
/// the database, the log and the listeners.
std::size_t bounded_connections(std::size_t wanted, double share, std::size_t descriptors);

}  // namespace alvor
