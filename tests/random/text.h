#pragma once
// A trial as files and commands that repeat it.

#include "tests/random/trial.h"

#include <string>

namespace alvor::test {

/// The shortest that reads back as the same number.
std::string exact_text(double value);

std::string obj_text(const Scene& scene);
/// Two-sided materials and the medium, which MTL does not know, are remarks.
std::string mtl_text(const Scene& scene);
/// `alvor solve` with its options.
std::string command_text(const Trial& trial);

}  // namespace alvor::test
