// Fuzzes the client's decoding: any frames, one after the other.

#include "proto/codec.h"
#include "solution/solution_mirror.h"
#include "tests/fuzz/allocation_limit.h"
#include "tests/fuzz/input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  alvor::fuzz::Input input(data, size);
  alvor::SolutionMirror mirror;
  while (!input.empty()) {
    alvor::v1::WatchSolveResponse message;
    const auto bytes = input.text();
    if (!message.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()))) continue;
    const alvor::fuzz::AllocationLimit twice_the_input(2 * size + (1 << 20));
    alvor::Delta delta;
    if (!decode(message, delta)) (void)mirror.apply(delta);
  }
  (void)mirror.leaves();
  return 0;
}
