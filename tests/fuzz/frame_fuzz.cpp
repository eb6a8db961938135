// What a client decodes: any frames, one after the other.

#include "proto/codec.h"
#include "solution/solution_mirror.h"
#include "tests/fuzz/input.h"

#include <google/protobuf/stubs/logging.h>

// What is no message is told to nobody.
extern "C" int LLVMFuzzerInitialize(int*, char***) {
  google::protobuf::SetLogHandler(nullptr);
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  alvor::fuzz::Input input(data, size);
  alvor::SolutionMirror mirror;
  while (!input.empty()) {
    alvor::v1::WatchSolveResponse message;
    const auto bytes = input.text();
    if (!message.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()))) continue;
    alvor::Delta delta;
    if (!decode(message, delta)) (void)mirror.apply(delta);
  }
  (void)mirror.leaves();
  return 0;
}
