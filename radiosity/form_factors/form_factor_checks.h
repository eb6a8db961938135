#pragma once
// Checks how well a scene's form factors obey the laws of form factors.

#include "radiosity/form_factors/face_form_factor.h"

#include <cstdint>
#include <string_view>
#include <vector>

namespace alvor {

/// The deviations from one law by one method, over pairs or faces taken at random.
struct FormFactorCheck {
  std::string_view law;     ///< "reciprocity", "additivity" or "closure"
  std::string_view method;  ///< "analytic" or "nusselt"
  std::size_t count = 0;
  double rms = 0, worst = 0;  ///< RMS and largest magnitude of the deviation, which check_form_factors() defines
};

/// Checks three laws and returns the deviations from them. Reciprocity: the difference between A_i F_ij and A_j F_ji, relative to
/// their mean. Additivity: the difference between F_ij and the sum of the factors to two parts of j, relative to F_ij. Closure: 1
/// minus a face's row sum, which is 0 in a closed scene; otherwise light leaves the scene or meets backs. Pairs that do not see
/// each other are passed over. One seed always checks the same pairs.
std::vector<FormFactorCheck> check_form_factors(const Scene& scene, std::size_t pairs, std::size_t faces, std::uint64_t seed);

}  // namespace alvor
