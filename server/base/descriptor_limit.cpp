#include "server/base/descriptor_limit.h"

#include <sys/resource.h>

#include <algorithm>

namespace alvor {

namespace {

constexpr std::size_t reserved = 128;  // an idle server has some 40 open

}  // namespace

std::size_t raise_descriptor_limit() {
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0) return 1024;
  limit.rlim_cur = limit.rlim_max;
  setrlimit(RLIMIT_NOFILE, &limit);  // where it is refused, the old one holds
  getrlimit(RLIMIT_NOFILE, &limit);
  return limit.rlim_cur;
}

std::size_t bounded_connections(std::size_t wanted, double share, std::size_t descriptors) {
  const std::size_t free = descriptors - std::min(descriptors, reserved);
  return std::clamp<std::size_t>(static_cast<std::size_t>(share * static_cast<double>(free)), 1,
                                 std::max<std::size_t>(wanted, 1));
}

}  // namespace alvor
