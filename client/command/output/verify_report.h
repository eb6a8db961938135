#pragma once
// What verify prints.

#include "client/verify/verification.h"

#include <span>
#include <string>

namespace alvor {

struct VerifyTimes {
  double elapsed_s = 0, cpu_s = 0;
};

/// Errors, how well the truth is known, and the worst places.
std::string verify_summary(const Scene& scene, const Verification& verification, const VerifyTimes& times);

/// One object. Errors are fractions.
std::string verify_json(const Scene& scene, const Verification& verification, const VerifyTimes& times,
                        std::span<const std::string> warnings);

}  // namespace alvor
