#pragma once

#include <cstddef>

namespace alvor::fuzz {

/// While it lives, an allocation by this thread of more than `bytes` at once is a finding. For our own code: protobuf reserves up
/// to 50 MB for a string whose declared length lies, where the length of the message around it lies too. One at a time.
class AllocationLimit {
 public:
  explicit AllocationLimit(std::size_t bytes);
  ~AllocationLimit();
  AllocationLimit(const AllocationLimit&) = delete;
  AllocationLimit& operator=(const AllocationLimit&) = delete;
};

}  // namespace alvor::fuzz
