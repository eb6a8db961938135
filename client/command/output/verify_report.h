#pragma once
// The output of `alvor verify`.

#include "client/verify/verification.h"

#include <span>
#include <string>

namespace alvor {

struct VerifyTimes {
  double elapsed_s = 0, cpu_s = 0;
};

/// Returns a text for people: errors, noise of the truth, and the worst places.
std::string verify_summary(const Scene& scene, const Verification& verification, const VerifyTimes& times);

/// Returns one JSON object. Errors are fractions.
std::string verify_json(const Scene& scene, const Verification& verification, const VerifyTimes& times,
                        std::span<const std::string> warnings);

}  // namespace alvor
