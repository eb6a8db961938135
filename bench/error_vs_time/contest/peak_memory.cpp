#include "bench/error_vs_time/contest/peak_memory.h"

#include "client/command/output/run_program.h"

#include <sys/resource.h>

#include <stdexcept>

namespace alvor::bench {

std::uint64_t peak_memory_of(const std::filesystem::path& program, const std::vector<std::string>& arguments) {
  if (!run_program(".", program, arguments)) throw std::runtime_error(program.string() + ": failed");
  rusage used{};
  getrusage(RUSAGE_CHILDREN, &used);
  return static_cast<std::uint64_t>(used.ru_maxrss) * 1024;  // Linux counts in KiB
}

}  // namespace alvor::bench
