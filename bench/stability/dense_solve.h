#pragma once
// The system of transport rows as a dense matrix: the slow and sure way.

#include "radiosity/exchange/shooting.h"

#include <vector>

namespace alvor::bench {

/// Irradiance by patch in the second band, by Gaussian elimination with partial pivoting in long double. Cubic in the number of
/// patches. Requires: nothing of the system is shot, hits weigh the same.
std::vector<double> dense_irradiance(const Shooting& unshot_system);

}  // namespace alvor::bench
