#include "radiosity/ranks/ranks.h"

#include <cassert>
#include <cstdlib>
#include <iostream>

namespace alvor {

template <class Call>
void Ranks::collective(std::size_t bytes_received, Call&& call) {
  const auto begun = Clock::now();
  call();
  spent_.collectives_s += seconds_since(begun);
  spent_.bytes_received += bytes_received;
  ++spent_.collectives;
}

void Ranks::gather(std::span<std::byte> all, std::span<const std::size_t> first) {
  if (is_alone()) return;
  assert(first.size() == size() + 1 && first.front() == 0 && first.back() == all.size());
  collective(all.size() - (first[rank() + 1] - first[rank()]), [&] { do_gather(all, first); });
}

void Ranks::sum(std::span<std::uint64_t> values) {
  if (!is_alone()) collective(values.size_bytes(), [&] { do_sum(values); });
}

void Ranks::broadcast(std::span<std::byte> bytes) {
  if (!is_alone()) collective(is_first() ? 0 : bytes.size(), [&] { do_broadcast(bytes); });
}

bool Ranks::any_of(bool here) {
  std::uint64_t count = here;
  sum({&count, 1});
  return count > 0;
}

void Ranks::end_all(const std::string& why) {
  std::cerr << name() << ": " << why << std::endl;
  do_end_all();
  std::_Exit(1);
}

Ranks& Ranks::alone() {
  static Ranks ranks;
  return ranks;
}

}  // namespace alvor
