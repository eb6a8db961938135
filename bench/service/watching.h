#pragma once
// Watchers of one solve, and what each saw of it.

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

namespace alvor::bench {

/// A frame as it arrived.
struct Arrival {
  double at_s = 0;       ///< on the machine's steady clock
  double elapsed_s = 0;  ///< of the newest step in it, on the solve's clock; negative: none
  std::uint64_t bytes = 0;
  std::uint64_t to_revision = 0, head = 0;
};

/// Watches until the solve has ended. Each on a connection of its own.
std::vector<Arrival> watch(const std::string& address, const std::string& solve, double rate_hz);

double now_s();

}  // namespace alvor::bench
