#pragma once
// How much memory the program asked for by new.

#include <cstddef>

namespace alvor::bench {

/// From now on; returns what is in use.
std::size_t begin_heap_peak();
/// The most that was in use since, bytes.
std::size_t heap_peak();

}  // namespace alvor::bench
