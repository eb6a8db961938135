#include "radiosity/ranks/launched_ranks.h"

#include <dlfcn.h>
#include <sched.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <thread>

namespace alvor {

namespace {

constexpr const char* module_name = "alvor-mpi.so";

/// Returns whether the environment is that of a process of Open MPI's mpirun, or of Slurm's srun with PMIx or PMI-2.
bool is_launched() {
  for (const char* const name : {"OMPI_COMM_WORLD_SIZE", "PMIX_NAMESPACE", "PMI_SIZE"})
    if (std::getenv(name) != nullptr) return true;
  return false;
}

void* load_module() {
  const auto folder = std::filesystem::read_symlink("/proc/self/exe").parent_path();
  const auto beside = folder / module_name;
  const auto path = std::filesystem::exists(beside) ? beside : folder.parent_path() / "lib" / "alvor" / module_name;
  // Open MPI loads modules of its own, which look for its symbols among the global ones.
  if (void* const module = dlopen(path.c_str(), RTLD_NOW | RTLD_GLOBAL)) return module;
  throw std::runtime_error("started as one of several ranks, but MPI cannot be loaded: " + std::string(dlerror()));
}

}  // namespace

std::unique_ptr<Ranks> launched_ranks() {
  if (!is_launched()) return nullptr;
  using Make = Ranks* (*)();
  const auto make = reinterpret_cast<Make>(dlsym(load_module(), "alvor_make_ranks"));
  std::unique_ptr<Ranks> ranks(make != nullptr ? make() : nullptr);
  if (!ranks) throw std::runtime_error("MPI cannot be called from several threads at a time");
  return ranks->is_alone() ? nullptr : std::move(ranks);
}

int threads_of(const Ranks& ranks) {
  const int all = static_cast<int>(std::thread::hardware_concurrency());
  cpu_set_t mine;
  CPU_ZERO(&mine);
  const int allowed = sched_getaffinity(0, sizeof(mine), &mine) == 0 ? CPU_COUNT(&mine) : all;
  if (ranks.is_alone()) return all;
  // A launcher that binds ranks gives each its own processors.
  return std::max(1, allowed < all ? allowed : all / static_cast<int>(ranks.ranks_on_this_machine()));
}

}  // namespace alvor
