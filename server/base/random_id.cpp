#include "server/base/random_id.h"

#include <random>

namespace alvor {

std::string random_id(char first) {
  static constexpr char digits[] = "0123456789abcdef";
  std::random_device source;
  std::string id(1, first);
  for (int word = 0; word < 2; ++word)
    for (unsigned bits = source(), digit = 0; digit < 8; ++digit, bits >>= 4) id += digits[bits & 15];
  return id;
}

}  // namespace alvor
