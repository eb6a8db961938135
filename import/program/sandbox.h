#pragma once
// Takes from this process all rights that reading a scene does not need.

#include <cstdint>

namespace alvor {

struct SandboxLimits {
  std::uint64_t memory_bytes = 0;  ///< of address space; not limited under sanitizers, which reserve terabytes
  std::uint64_t cpu_seconds = 0;
};

/// From here on the process can compute, allocate memory up to the limit, and read and write the descriptors that it has open.
/// Any other system call, such as one that opens a file or a socket or starts a program, ends it with SIGSYS. It also ends when
/// its parent does. Throws std::runtime_error if the system does not allow that.
void enter_sandbox(const SandboxLimits& limits);

}  // namespace alvor
