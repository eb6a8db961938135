#pragma once
// Finds out whether a launcher started this program as several ranks.

#include "radiosity/ranks/ranks.h"

#include <memory>

namespace alvor {

/// Returns the ranks that mpirun or srun started, of which this process is one; null if it was started alone. To be called once,
/// from the main thread; the ranks must be destroyed before it ends. Throws runtime_error where the module alvor-mpi.so cannot be
/// loaded, which lies beside the program or in ../lib/alvor.
std::unique_ptr<Ranks> launched_ranks();

/// Returns how many threads a solve of these ranks should use here: the processors that this process may run on, shared with the
/// other ranks of this machine if they may run on the same ones.
int threads_of(const Ranks& ranks);

}  // namespace alvor
