#pragma once

#include <ostream>

namespace alvor::bench {

/// Prints the cost of publishing, encoding and decoding per leaf, and per second at 10 Hz with a million leaves.
void print_publishing(std::ostream& out);

}  // namespace alvor::bench
