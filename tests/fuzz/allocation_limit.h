#pragma once

#include <cstddef>

namespace alvor::fuzz {

/// While it exists, this thread must not allocate more than `bytes` at once. Meant for our own code: protobuf reserves up to 50
/// MB for a string whose declared length is false, if the length of the message around it is false too. One at a time.
class AllocationLimit {
 public:
  explicit AllocationLimit(std::size_t bytes);
  ~AllocationLimit();
  AllocationLimit(const AllocationLimit&) = delete;
  AllocationLimit& operator=(const AllocationLimit&) = delete;
};

}  // namespace alvor::fuzz
