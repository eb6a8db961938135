#pragma once
// Watches a solve and records the arrival of frames.

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

namespace alvor::bench {

/// The arrival of one frame.
struct Arrival {
  double at_s = 0;       ///< on the machine's steady clock, s
  double elapsed_s = 0;  ///< time of its newest step on the solve's clock, s; negative if it has no step
  std::uint64_t bytes = 0;
  std::uint64_t to_revision = 0, head = 0;
};

/// Watches until the solve has ended, over a new connection. Returns all arrivals.
std::vector<Arrival> watch(const std::string& address, const std::string& solve, double rate_hz);

double now_s();

}  // namespace alvor::bench
