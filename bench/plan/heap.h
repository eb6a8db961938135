#pragma once
// Counts the memory that the program allocates by new.

#include <cstddef>

namespace alvor::bench {

/// Starts a new measurement of the peak. Returns the bytes in use now.
std::size_t begin_heap_peak();
/// Returns the most bytes in use since begin_heap_peak().
std::size_t heap_peak();

}  // namespace alvor::bench
