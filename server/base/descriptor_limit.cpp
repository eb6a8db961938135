#include "server/base/descriptor_limit.h"

#include <sys/resource.h>

#include <algorithm>

namespace alvor {

namespace {

// Descriptors kept for the database, the log and the listeners. An idle server has about 40 open.
constexpr std::size_t reserved = 128;

}  // namespace

std::size_t raise_descriptor_limit() {
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0) return 1024;
  limit.rlim_cur = limit.rlim_max;
  setrlimit(RLIMIT_NOFILE, &limit);  // if this fails, the old limit stays
  getrlimit(RLIMIT_NOFILE, &limit);
  return limit.rlim_cur;
}

std::size_t bounded_connections(std::size_t wanted, double share, std::size_t descriptors) {
  const std::size_t free = descriptors - std::min(descriptors, reserved);
  return std::clamp<std::size_t>(static_cast<std::size_t>(share * static_cast<double>(free)), 1,
                                 std::max<std::size_t>(wanted, 1));
}

}  // namespace alvor
