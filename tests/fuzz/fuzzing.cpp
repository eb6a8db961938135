// Shared by all fuzz targets: silences messages about bad input, and detects too large allocations.

#include "tests/fuzz/allocation_limit.h"

#include <google/protobuf/stubs/logging.h>
#include <sanitizer/allocator_interface.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>

namespace alvor::fuzz {
namespace {

thread_local std::size_t largest_allowed = SIZE_MAX;

void allocated(const volatile void*, std::size_t bytes) {
  if (bytes <= largest_allowed) return;
  const std::size_t allowed = largest_allowed;
  largest_allowed = SIZE_MAX;
  std::fprintf(stderr, "allocation of %zu bytes, where %zu are allowed\n", bytes, allowed);
  std::abort();
}

}  // namespace

AllocationLimit::AllocationLimit(std::size_t bytes) { largest_allowed = bytes; }
AllocationLimit::~AllocationLimit() { largest_allowed = SIZE_MAX; }

}  // namespace alvor::fuzz

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  google::protobuf::SetLogHandler(nullptr);
  __sanitizer_install_malloc_and_free_hooks(alvor::fuzz::allocated, [](const volatile void*) {});
  return 0;
}
