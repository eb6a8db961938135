#pragma once
// Solves the system of transport rows as a dense matrix, slowly but reliably.

#include "radiosity/exchange/shooting.h"

#include <vector>

namespace alvor::bench {

/// Returns the irradiance of each patch in the second band, by Gaussian elimination with partial pivoting in long double. Cubic
/// in the number of patches. Requires: nothing of the system has been shot; all hits have the same weight.
std::vector<double> dense_irradiance(const Shooting& unshot_system);

}  // namespace alvor::bench
